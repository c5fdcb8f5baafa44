#include "systems/laws/pose_goals.h"

#include <utility>

#include "systems/laws/pose_guidance.h"
#include "systems/robot/reaction_tasks.h"

namespace flinch {
namespace {

TaskGains for_rows(const TaskGains& one, int rows) {
  return TaskGains::uniform(rows, one.velocity[0], one.stiffness[0], one.damping[0], one.force[0],
                            one.damping_ratio[0]);
}

}  // namespace

PoseGoals::PoseGoals(std::shared_ptr<const ParallelRobot> robot, const PoseGoalSettings& settings)
    : robot_(std::move(robot)),
      position_(for_rows(settings.position, robot_->space().translations())),
      orientation_(for_rows(settings.orientation, robot_->space().rotations())) {}

void PoseGoals::lead(const PlatformReference& desired, const Kinematics& at, TaskList& list) const {
  list.count = 0;
  list.valid = desired.valid && at.reachable && robot_->space().contains(desired.pose) &&
               desired.velocity.size() == robot_->dof() && desired.acceleration.size() == robot_->dof();
  if (!list.valid) return;
  const PoseGuidance guidance = guide(robot_->space(), desired, at.pose, at.velocity);
  const int translations = robot_->space().translations();
  list.add({platform_position_task(*robot_, at),
            {guidance.error.head(translations), guidance.velocity.head(translations),
             guidance.acceleration.head(translations)},
            position_});
  const int rotations = robot_->space().rotations();
  if (rotations == 0) return;
  list.add({platform_orientation_task(*robot_, at),
            {guidance.error.tail(rotations), guidance.velocity.tail(rotations),
             guidance.acceleration.tail(rotations)},
            orientation_});
}

}  // namespace flinch
