#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/motion_barriers.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/braking_status.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/reaction_state.h"

namespace flinch {

/// Looks at the tick at which the robot leaves its nominal motion for a contact whether it could stop within
/// its limits from there, see braking_set.h: that tick alone costs some 13 evaluations of the model.
class BrakingMonitor final : public System {
 public:
  /// `max_torque` of a drive [Nm or N]. Throws SetupError where it is not positive.
  BrakingMonitor(std::shared_ptr<const ParallelRobot> robot, const PoseConstraints& limits,
                 double max_torque);

  InputPort<ReactionState> reaction = input<ReactionState>("reaction");
  InputPort<PlatformMotion> motion = input<PlatformMotion>("motion");

 private:
  Intermediate<bool> begins_ = intermediate<&BrakingMonitor::begins>("begins", clock, reaction);

 public:
  OutputPort<BrakingStatus> status =
      output<&BrakingMonitor::judge>(When(begins_), "status", clock, begins_, motion);

 private:
  bool begins(Time now, const ReactionState& state) const;
  BrakingStatus judge(Time now, bool begins, const PlatformMotion& moving) const;

  std::shared_ptr<const ParallelRobot> robot_;
  PoseConstraints limits_;
  double max_torque_;
};

}  // namespace flinch
