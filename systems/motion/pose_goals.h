#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/motion/pose_goal_settings.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/task_list.h"

namespace flinch {

/// Adds to `list` the platform's position and below it, where it can turn, its orientation, to be led to
/// `desired`: valid, and of this robot. `at` must be reachable. [SafePR] Table II
void add_pose_goals(const ParallelRobot& robot, const PoseGoalSettings& settings,
                    const PlatformReference& desired, const Kinematics& at, TaskList& list) noexcept;

/// Turns a reference of the platform into these tasks.
class PoseGoals final : public System {
 public:
  PoseGoals(std::shared_ptr<const ParallelRobot> robot, const PoseGoalSettings& settings);

  InputPort<PlatformReference> reference = input<PlatformReference>("reference");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  OutputPort<TaskList> goals = output<&PoseGoals::lead>("goals", reference, kinematics);

 private:
  void lead(const PlatformReference& desired, const Kinematics& at, TaskList& list) const;

  std::shared_ptr<const ParallelRobot> robot_;
  PoseGoalSettings settings_;
};

}  // namespace flinch
