#pragma once

#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "systems/framework/tick_timing.h"
#include "systems/framework/time.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"
#include "systems/safety/encoder_monitor.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/drive_check_status.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/gate_fault.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/operator_command.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/plausibility.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {

/// Where a fault begins. The defaults are those of the rig.
struct FaultLimits {
  Time max_lateness = 2ms;  ///< of a tick, in real time
  Time longest_gap = 2ms;   ///< without a usable sample; the filters hold their last one as long
  Time max_age = 3ms;       ///< of a sample, by its acquisition time, and of the laws' command

  /// Between two readings, whose interval counts as 1 ms at least. Half as much again as `max_joint_speed`,
  /// at which the robot is stopped: left for the stamps to be off by a third of a millisecond. Noise is 1e-5
  /// rad.
  double max_encoder_rate = 12.0;  ///< [rad/s]
  /// An encoder may repeat itself to the last bit for as long, whatever it should have seen. The rig's
  /// noise of 33 increments alone makes six equal readings a matter of 1e-10.
  Time longest_repetition = 5ms;
  /// And for longer, if the passive encoders have not left it by more than ten of their increments meanwhile,
  double max_unseen_motion = 0.25 * std::numbers::pi / 180.0;  ///< [rad]
  /// nor its drive's torque has changed by ten times the friction of a drive: 6 Nm, which no obstacle is
  /// stiff enough to hold within one increment.
  double max_unseen_current = 1.0;  ///< [A]

  WorkspaceLimits workspace{.centre = {},
                            .max_distance = 0.35,
                            .max_rotation = 29.0 * std::numbers::pi / 180.0,
                            .min_abs_det_A = 0.2,
                            .min_abs_det_B = 0.15,
                            .min_self_collision_distance = 0.05,
                            .min_active = -35.0 * std::numbers::pi / 180.0,
                            .max_active = 150.0 * std::numbers::pi / 180.0};  ///< [PAR]
  double max_joint_speed = 8.0;                                               ///< of a drive [rad/s]
  double rest_speed = 0.05;                                    ///< below it a drive counts as at rest [rad/s]
  double max_control_error = 25.0 * std::numbers::pi / 180.0;  ///< of a drive [rad]. [PAR]
  double max_torque_jump = 40.0;  ///< from tick to tick, both within the torque range [Nm]
  double torque_range = 100.0;    ///< what lies outside counts as its end [Nm]

  /// While the robot recovers: the share of `max_joint_speed` that is left, and by how much it may get
  /// further beyond a limit than it was, as a share of the limit: for noise and for a motion that begins.
  double recovery_speed = 0.15;
  /// The same where passive encoders have been lost, by which an active one that lies would have been found.
  double degraded_speed = 0.5;
  double recovery_margin = 0.02;
};

/// All that is wrong with `limits`, one sentence each. A robot at rest at home must be within them.
std::vector<std::string> problems(const FaultLimits& limits, const ParallelRobot& robot);

/// All that faults are judged by, at one tick.
struct Evidence {
  const ParallelRobot& robot;
  const FaultLimits& limits;
  Time now;

  const TickTiming& timing;  ///< of this tick; not valid in simulated time
  const StationStatus& station;
  const JointReading& joints;
  const DriveReading& drives;
  Time station_gap, joints_gap, drives_gap;  ///< since their last usable sample

  const EncoderMonitor& encoders;
  const JointMotion& motion;
  const PlatformMotion& platform;
  const WorkspaceMeasures& measures;
  const ContactDetection& detection;
  const PlatformReference& reference;  ///< that is being followed; not valid where none is
  const TorqueCommand& command;
  const TorqueCommand& last_command;  ///< of the tick before
  const OperatorCommand& buttons;
  const ReactionState& reaction;
  const Plausibility& plausibility;  ///< not valid where nobody asks
  const DriveCheckStatus& drive_check;

  bool has_motion, has_pose, has_command;  ///< whether these are usable
};

/// What a fault calls in doubt.
enum class Doubt : std::uint8_t {
  nothing,   ///< where the robot is or what is wanted is wrong, and what is known of it is right
  time,      ///< ticks and commands do not come when they should
  angles,    ///< and so the rates
  rates,     ///< of the drives
  drives,    ///< whether they and their brakes do as they are told
  currents,  ///< what is measured of the motors
  laws,      ///< what they ask for
};

/// What follows: a controlled stop needs ticks, rates and drives that can be trusted; where one of them is in
/// doubt, torque by them would drive the robot, and only brakes are left.
constexpr GateReaction reaction_to(Doubt doubt) {
  const bool needed =
      doubt == Doubt::time || doubt == Doubt::angles || doubt == Doubt::rates || doubt == Doubt::drives;
  return needed ? GateReaction::zero_torque_and_brake : GateReaction::controlled_stop;
}

/// One fault: when it is present, what the gate then does, how soon.
struct FaultRow {
  GateFault fault;
  Doubt doubt;  ///< all else is trusted
  /// Ticks of 1 ms, with the default limits, from the tick at which the cause first shows to the tick at
  /// which the gate reacts: 0 is the same tick.
  int latency;
  bool (*present)(const Evidence& evidence);
  const char* description;

  constexpr GateReaction reaction() const { return reaction_to(doubt); }
};

/// One row for each fault but `none`, in their order. A row whose own inputs are missing stays silent: the
/// row above that guards them speaks.
std::span<const FaultRow> fault_table() noexcept;

/// Whether a sample can be worked with: valid, of the robot's size and finite.
bool is_usable(const JointReading& joints, const ParallelRobot& robot) noexcept;
bool is_usable(const DriveReading& drives, const ParallelRobot& robot) noexcept;
bool is_usable(const JointMotion& motion, const ParallelRobot& robot) noexcept;
bool is_usable(const PlatformMotion& platform, const ParallelRobot& robot) noexcept;
bool is_usable(const TorqueCommand& command, const ParallelRobot& robot) noexcept;

/// The faults that call this in doubt.
FaultMask faults_that_doubt(Doubt doubt) noexcept;

/// All faults present.
FaultMask find_faults(const Evidence& evidence) noexcept;

/// The first of a set, in the order of the table; none for the empty set.
GateFault first_fault(FaultMask faults) noexcept;

/// The severest reaction that one of the set asks for.
GateReaction worst_reaction(FaultMask faults) noexcept;

}  // namespace flinch
