#include "systems/laws/braking_monitor.h"

#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/robot/braking_set.h"

namespace flinch {

BrakingMonitor::BrakingMonitor(std::shared_ptr<const ParallelRobot> robot, const PoseConstraints& limits,
                               double max_torque)
    : robot_(std::move(robot)), limits_(limits), max_torque_(max_torque) {
  if (!(max_torque > 0)) throw SetupError("braking watch: max_torque must be positive");
}

bool BrakingMonitor::begins(Time now, const ReactionState& state) const {
  return state.since == now && state.previous == ReactionMode::nominal &&
         (state.mode == ReactionMode::react || state.mode == ReactionMode::zero_g);
}

BrakingStatus BrakingMonitor::judge(Time now, bool begins, const PlatformMotion& moving) const {
  BrakingStatus found;
  found.judged = now;
  if (!begins || !moving.valid()) return found;
  Kinematics at;
  Dynamics dynamics;
  robot_->kinematics(moving.pose, moving.velocity, at);
  robot_->dynamics(at, dynamics);
  if (!at.valid || !dynamics.valid) return found;
  const StraightStop stop = straight_stop(*robot_, at, dynamics, limits_, max_torque_);
  found.valid = true;
  found.stays_inside = stop.stays_inside;
  found.duration = stop.duration;
  return found;
}

}  // namespace flinch
