#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "plant/delay_line.h"
#include "plant/rig_dynamics.h"
#include "plant/sensor_noise.h"
#include "systems/framework/system.h"
#include "systems/signals/force_torque_reading.h"

namespace flinch {

/// The force-torque sensor between an obstacle and the base.
struct SimulatedForceTorqueSettings {
  bool ideal = false;           ///< Readings are the truth, at once.
  int obstacle = 0;             ///< The obstacle that it carries, by its place in the list.
  double depth = 0.1;           ///< Of the sensor's origin below the obstacle's position [m].
  double force_noise = 0.05;    ///< Standard deviation of white noise [N]; assumed.
  double moment_noise = 0.002;  ///< [Nm]; assumed.
  Time period = 1ms;            ///< Mini40: 1000 Hz, [SafePR] V-A.
  Time delay = 0ms;             ///< From measurement to delivery, at the first tick thereafter.
};

std::vector<std::string> problems(const SimulatedForceTorqueSettings& settings);

/// Measures what an obstacle does to the robot, through what holds the obstacle: on a fixed mounting that is
/// the contact force; on a compliant one the force of its spring and damper.
class SimulatedForceTorqueSensor final : public System {
 public:
  /// `position_in_base`: of the obstacle at rest [m]. Throws SetupError.
  SimulatedForceTorqueSensor(const SimulatedForceTorqueSettings& settings,
                             const Eigen::Vector3d& position_in_base, std::uint64_t seed);

 private:
  SimulatedForceTorqueSettings settings_;
  Eigen::Vector3d position_in_base_;
  State<NormalNumbers<6>> noise_;
  State<DelayLine<ForceTorqueReading>> underway_ = state<DelayLine<ForceTorqueReading>>("underway");

 public:
  InputPort<RigSnapshot> snapshot = input<RigSnapshot>("snapshot");

 private:
  Intermediate<ForceTorqueReading> measured_ =
      intermediate<&SimulatedForceTorqueSensor::measure>("measured", clock, snapshot, noise_);

 public:
  OutputPort<ForceTorqueReading> force_torque =
      output<&SimulatedForceTorqueSensor::deliver>("force_torque", clock, measured_, underway_);

 private:
  Update draw_ = update<&SimulatedForceTorqueSensor::draw>(noise_);
  Update send_ = update<&SimulatedForceTorqueSensor::send>(Every{settings_.period}, underway_, measured_);

  void measure(Time now, const RigSnapshot& rig, const NormalNumbers<6>& noise,
               ForceTorqueReading& reading) const;
  void deliver(Time now, const ForceTorqueReading& fresh, const DelayLine<ForceTorqueReading>& underway,
               ForceTorqueReading& reading) const;
  void send(const ForceTorqueReading& fresh, DelayLine<ForceTorqueReading>& underway) const {
    underway.push(fresh);
  }
  void draw(NormalNumbers<6>& noise) const { noise.draw(); }
};

}  // namespace flinch
