#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/laws/pose_goal_settings.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/task_list.h"

namespace flinch {

/// Turns a reference of the platform into tasks: first its position, then its orientation where it has one.
/// [SafePR] Table II
class PoseGoals final : public System {
 public:
  PoseGoals(std::shared_ptr<const ParallelRobot> robot, const PoseGoalSettings& settings);

  InputPort<PlatformReference> reference = input<PlatformReference>("reference");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  OutputPort<TaskList> goals = output<&PoseGoals::lead>("goals", reference, kinematics);

 private:
  void lead(const PlatformReference& desired, const Kinematics& at, TaskList& list) const;

  std::shared_ptr<const ParallelRobot> robot_;
  TaskGains position_;
  TaskGains orientation_;
};

}  // namespace flinch
