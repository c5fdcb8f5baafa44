#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/torque_command.h"

namespace flinch {

struct ControlledStopSettings {
  /// D [Nms/rad] of every drive. With 0.58 kg m^2 at a drive of the rig it brakes with a time constant of
  /// 29 ms, well damped behind a velocity filter of 30 Hz.
  double damping = 20.0;
  /// Below this speed of the fastest drive D falls with the speed [rad/s or m/s],
  double whole_from = 2.0;
  /// to this share of it at rest: with 0.25 a hand of 15 N leads the rig at 0.1 m/s, friction included.
  double share_at_rest = 1.0;
};

/// Brings the drives to rest and leaves the robot movable by hand: tau = g_qa - D(dq_a) dq_a.
///
/// It needs only the drives' rates. Where the pose is lost it goes on with the last g_qa that was known;
/// where that was never known or the rates are missing, it is not valid and only the brakes are left.
class ControlledStop final : public System {
  State<TorqueCommand> gravity_ = state<TorqueCommand>("gravity");  ///< last valid g_qa

 public:
  /// Throws SetupError for settings that are not positive.
  ControlledStop(std::shared_ptr<const ParallelRobot> robot, const ControlledStopSettings& settings);

  InputPort<TorqueCommand> zero_gravity = input<TorqueCommand>("zero_gravity");
  InputPort<JointMotion> joints = input<JointMotion>("joints");
  OutputPort<TorqueCommand> torque =
      output<&ControlledStop::brake>("torque", clock, gravity_, zero_gravity, joints);

 private:
  Update remember_ = update<&ControlledStop::remember>(gravity_, gravity_, zero_gravity);

  void brake(Time now, const TorqueCommand& known, const TorqueCommand& compensation,
             const JointMotion& motion, TorqueCommand& command) const;
  double damping_at(const JointVector& rates) const;
  void remember(const TorqueCommand& known, const TorqueCommand& compensation, TorqueCommand& next) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ControlledStopSettings settings_;
};

}  // namespace flinch
