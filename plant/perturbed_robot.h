#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plant/position_wave.h"
#include "plant/realism.h"
#include "plant/simulated_station.h"
#include "plant/torque_ripple.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/robot_deviation.h"

namespace flinch {

/// One of the robots that are built alike: what is true of it and not of its model. What is empty is as the
/// model says.
struct PerturbedRobot {
  RobotDeviation mechanics;
  JointVector friction_stiffness;           ///< Of each drive, whose dry friction sticks [Nm/rad or N/m].
  ElasticDrivesSettings elastic{};          ///< Between motors and legs.
  JointVector torque_constant_scale;        ///< Of each motor.
  JointVector current_lag;                  ///< Of each drive, time constant [s].
  std::vector<TorqueRipple> torque_ripple;  ///< Of each drive.
  std::vector<PositionHarmonic> active_encoder_wave;
  std::vector<PositionHarmonic> passive_encoder_wave;
  JointVector passive_encoder_offset;  ///< [rad]
};

/// Draws one: what may be off either way uniformly between both sizes, an amplitude, a lag or a payload
/// between zero and its size, phases on the circle. Each quantity has a sequence of its own, so that one size
/// does not change what is drawn of the others. `largest_torque` of a drive [Nm or N].
PerturbedRobot draw_perturbed_robot(const Realism& realism, const ParallelRobot& robot, double largest_torque,
                                    std::uint64_t seed);

/// The station of `model` with this robot in its place; motors of which the model says how they cog do so,
/// and likewise those whose torque is behind their current.
/// An offset of the passive encoders stands for the error that their accuracy would have drawn.
SimulatedStationSettings with_perturbed_robot(SimulatedStationSettings model,
                                              const PerturbedRobot& perturbed_robot);

/// All that is not as the model of `robot` says, in SI: under a key with its unit, such as "cogging_Nm", one
/// number for each joint, leg or encoder.
std::vector<std::pair<std::string, std::vector<double>>> perturbed_robot_values(
    const PerturbedRobot& perturbed_robot, const Mechanism& robot);

}  // namespace flinch
