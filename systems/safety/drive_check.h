#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/drive_check_status.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/torque_command.h"

namespace flinch {

struct DriveCheckSettings {
  double torque = 12.0;     ///< that each drive is given, well above what its friction holds [Nm or N]
  double least_gain = 0.3;  ///< below it a drive is dead, or held, or of the wrong sign
  double most_gain = 2.5;   ///< above it a drive gives more than it is told
  Time period = 1ms;        ///< from tick to tick
};

/// Tries each drive before the first motion: while the laws hold the robot at rest, one drive after another
/// is given a small torque besides, there, back, back and there, each for some milliseconds. Without friction
/// it moves a little and comes back to where it was. How far it moves, over what the model makes of that
/// torque, is its gain: a least-squares fit, beside a parabola in time for what the robot does anyway.
///
/// It begins whenever the nominal mode begins, until it has passed once. A drive whose gain is outside the
/// bounds ends it, and is told until the laws' torques no longer reach the station.
class DriveCheck final : public System {
 public:
  using Phase = DriveCheckStatus::Phase;
  struct Memory {
    DriveCheckStatus status{.phase = Phase::waiting, .drive = -1, .gain = {}};
    Time begin{};                  ///< tick at which the robot was at rest, or a drive got its torque
    JointVector angle;             ///< of all drives at that tick [rad or m]
    JointVector torque;            ///< of the laws at that tick [Nm or N]
    double rate = 0.0, way = 0.0;  ///< that the drive should have, and should have gone [rad/s, rad or m]
    /// Sums of a least-squares fit of the measured way by that way, and by 1, t and t^2.
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Vector4d products = Eigen::Vector4d::Zero();
  };

 private:
  State<Memory> last_ = state<Memory>("last");

 public:
  /// Throws SetupError for settings that are not positive.
  DriveCheck(std::shared_ptr<const ParallelRobot> robot, const DriveCheckSettings& settings);

  InputPort<TorqueCommand> command = input<TorqueCommand>("command");  ///< what the laws ask for
  InputPort<JointReading> joints = input<JointReading>("joints");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<PlatformReference> reference = input<PlatformReference>("reference");

 private:
  Intermediate<Memory> now_ = intermediate<&DriveCheck::advance>("memory", clock, last_, command, joints,
                                                                 kinematics, dynamics, reaction, reference);

 public:
  /// The laws' torques, and that of the drive which is being tried.
  OutputPort<TorqueCommand> torque = output<&DriveCheck::add_torque>("torque", clock, now_, command);
  /// As it was at the tick before.
  OutputPort<DriveCheckStatus> status = output<&DriveCheck::status_of>("status", last_);

 private:
  Update remember_ = keep(last_, now_);

  void advance(Time now, const Memory& last, const TorqueCommand& asked, const JointReading& angles,
               const Kinematics& at, const Dynamics& model, const ReactionState& state,
               const PlatformReference& followed, Memory& next) const;
  void add_torque(Time now, const Memory& memory, const TorqueCommand& asked, TorqueCommand& result) const;
  DriveCheckStatus status_of(const Memory& last) const { return last.status; }

  /// Begins with the next drive.
  void try_next(Time now, const JointReading& angles, const TorqueCommand& asked, Memory& next) const;
  void measure(Time now, const JointReading& angles, Memory& next) const;
  void predict(Time now, const TorqueCommand& asked, const Kinematics& at, const Dynamics& model,
               Memory& next) const;
  void judge(Memory& next) const;
  double added(Time now, const Memory& memory) const;

  std::shared_ptr<const ParallelRobot> robot_;
  DriveCheckSettings settings_;
  Time part_;  ///< of four for which a drive has its torque
};

}  // namespace flinch
