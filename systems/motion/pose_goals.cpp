#include "systems/motion/pose_goals.h"

#include <utility>

#include "systems/robot/reaction_tasks.h"
#include "systems/signals/pose_guidance.h"

namespace flinch {

void add_pose_goals(const ParallelRobot& robot, const PoseGoalSettings& settings,
                    const PlatformReference& desired, const Kinematics& at, TaskList& list) noexcept {
  const PoseGuidance guidance = guide(robot.space(), desired, at.pose, at.velocity);
  const int translations = robot.space().translations();
  list.add({platform_position_task(robot, at),
            {guidance.error.head(translations), guidance.velocity.head(translations),
             guidance.acceleration.head(translations)},
            settings.position.for_rows(translations)});
  const int rotations = robot.space().rotations();
  if (rotations == 0) return;
  list.add({platform_orientation_task(robot, at),
            {guidance.error.tail(rotations), guidance.velocity.tail(rotations),
             guidance.acceleration.tail(rotations)},
            settings.orientation.for_rows(rotations)});
}

PoseGoals::PoseGoals(std::shared_ptr<const ParallelRobot> robot, const PoseGoalSettings& settings)
    : robot_(std::move(robot)), settings_(settings) {}

void PoseGoals::lead(const PlatformReference& desired, const Kinematics& at, TaskList& list) const {
  list.count = 0;
  list.valid = desired.valid && at.reachable && robot_->space().contains(desired.pose) &&
               desired.velocity.size() == robot_->dof() && desired.acceleration.size() == robot_->dof();
  if (list.valid) add_pose_goals(*robot_, settings_, desired, at, list);
}

}  // namespace flinch
