#include "systems/laws/controlled_stop.h"

#include <utility>

#include "systems/foundation/setup_error.h"

namespace flinch {

ControlledStop::ControlledStop(std::shared_ptr<const ParallelRobot> robot,
                               const ControlledStopSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  if (!(settings.damping > 0)) throw SetupError("controlled stop: damping must be positive");
}

void ControlledStop::brake(Time now, const TorqueCommand& known, const TorqueCommand& compensation,
                           const JointMotion& motion, TorqueCommand& command) const {
  const TorqueCommand& gravity = compensation.valid ? compensation : known;
  const int drives = robot_->drives();
  command = {.computed = now, .valid = false, .torque = JointVector::Zero(drives)};
  if (!gravity.valid || !motion.valid) return;
  if (gravity.torque.size() != drives || motion.velocity.size() != drives) return;
  command.torque = gravity.torque - settings_.damping * motion.velocity;
  command.valid = command.torque.allFinite();
}

void ControlledStop::remember(const TorqueCommand& known, const TorqueCommand& compensation,
                              TorqueCommand& next) const {
  next = compensation.valid ? compensation : known;
}

}  // namespace flinch
