#include "systems/laws/controlled_stop.h"

#include <algorithm>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

ControlledStop::ControlledStop(std::shared_ptr<const ParallelRobot> robot,
                               const ControlledStopSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {
  Findings found("controlled stop: ");
  found.require(settings.damping > 0, "damping must be positive");
  found.require(settings.whole_from > 0, "whole_from must be positive");
  found.require(settings.share_at_rest > 0 && settings.share_at_rest <= 1,
                "share_at_rest must be above 0 and at most 1");
  throw_if_any(found.take());
}

double ControlledStop::damping_at(const JointVector& rates) const {
  const double share = rates.lpNorm<Eigen::Infinity>() / settings_.whole_from;
  return settings_.damping * std::clamp(share, settings_.share_at_rest, 1.0);
}

void ControlledStop::brake(Time now, const TorqueCommand& known, const TorqueCommand& compensation,
                           const JointMotion& motion, TorqueCommand& command) const {
  const TorqueCommand& gravity = compensation.valid ? compensation : known;
  const int drives = robot_->drives();
  command = {.computed = now, .valid = false, .torque = JointVector::Zero(drives)};
  if (!gravity.valid || !motion.valid) return;
  if (gravity.torque.size() != drives || motion.velocity.size() != drives) return;
  command.torque = gravity.torque - damping_at(motion.velocity) * motion.velocity;
  command.valid = command.torque.allFinite();
}

void ControlledStop::remember(const TorqueCommand& known, const TorqueCommand& compensation,
                              TorqueCommand& next) const {
  next = compensation.valid ? compensation : known;
}

}  // namespace flinch
