#include "diagrams/task_stages.h"

#include <algorithm>

#include "diagrams/contact_control_settings.h"
#include "diagrams/safety_filtering.h"
#include "systems/laws/task_controller.h"
#include "systems/laws/task_energy.h"
#include "systems/motion/constraint_monitor.h"
#include "systems/motion/pose_goals.h"
#include "systems/motion/reaction_task.h"

namespace flinch {
namespace {

/// The tasks that a law serves.
struct LedTasks {
  OutputPort<TaskList> goals;
  OutputPort<PlatformReference> reference;
};

LawPorts add_controller(const StageContext& site, TaskLevel level, const ConstraintSettings& constraints,
                        ConstraintMonitor::Role role, const ReactionPorts& given, const LedTasks& led) {
  DiagramBuilder& builder = site.builder;
  const TaskSettings& settings = site.settings.tasks;
  auto& watch = builder.add<ConstraintMonitor>(site.name + "_constraints", site.robot, constraints, role);
  builder.connect(given.reaction, watch.reaction);
  builder.connect(given.kinematics, watch.kinematics);

  auto& controller = builder.add<TaskController>(
      site.name, site.robot,
      TaskControllerSettings{.level = level, .levels = settings.levels, .blend = settings.blend});
  builder.connect(led.goals, controller.tasks);
  builder.connect(watch.goals, controller.constraint_goals);
  builder.connect(watch.constraints, controller.constraints);
  builder.connect(given.kinematics, controller.kinematics);
  builder.connect(given.dynamics, controller.dynamics);
  LawPorts law{.torque = controller.torque, .reference = led.reference, .constraints = watch.constraints};
  if (level != TaskLevel::torque) return law;
  auto& energy = builder.add<TaskEnergyMonitor>(site.name + "_energies");
  builder.connect(led.goals, energy.tasks);
  builder.connect(watch.goals, energy.constraint_goals);
  builder.connect(watch.constraints, energy.constraints);
  builder.connect(given.kinematics, energy.kinematics);
  builder.connect(given.dynamics, energy.dynamics);
  law.energies = energy.energies;
  return law;
}

LawPorts add_tracking(const StageContext& site, TaskLevel level, const ReactionPorts& given) {
  auto& goals = site.builder.add<PoseGoals>(site.name + "_goals", site.robot, site.settings.tasks.nominal);
  site.builder.connect(given.nominal, goals.reference);
  site.builder.connect(given.kinematics, goals.kinematics);
  return add_controller(site, level, site.settings.tasks.constraints, ConstraintMonitor::Role::nominal, given,
                        {goals.goals, given.nominal});
}

LawPorts add_reaction_with(const StageContext& site, TaskLevel level, const ConstraintSettings& constraints,
                           const ReactionTaskSettings& reaction, const ReactionPorts& given) {
  DiagramBuilder& builder = site.builder;
  auto& task =
      builder.add<ReactionTask>(site.name + "_task", site.robot, reaction, site.settings.tasks.nominal);
  builder.connect(given.reaction, task.reaction);
  builder.connect(given.kinematics, task.kinematics);
  builder.connect(given.dynamics, task.dynamics);
  builder.connect(given.isolation_wrench, task.estimate);
  builder.connect(given.classification, task.classification);
  builder.connect(given.location, task.location);
  LawPorts law = add_controller(site, level, constraints, ConstraintMonitor::Role::reacting, given,
                                {task.goals, task.reference});
  law.task = task.followed_task;
  return law;
}

LawPorts add_reaction(const StageContext& site, TaskLevel level, const ReactionPorts& given) {
  const TaskSettings& settings = site.settings.tasks;
  return add_reaction_with(site, level, settings.constraints, settings.reaction, given);
}

/// The safety filter holds the constraints: none becomes a task, and motions may take what the drives have,
/// from the first tick on.
LawPorts add_strict_reaction(const StageContext& site, TaskLevel level, const ReactionPorts& given) {
  ConstraintSettings watched = site.settings.tasks.constraints;
  watched.kept = ConstraintsKept::never;
  ReactionTaskSettings reaction = site.settings.tasks.reaction;
  reaction.drive_share = reaction.drive_share.value_or(planned_torque_share);
  LawPorts law = add_reaction_with(site, level, watched, reaction, given);
  law.at_once = true;
  return law;
}

/// The speed of the platform's origin at which, at home and whichever way it goes, the first drive reaches
/// `drive_speed` [m/s].
double platform_speed_at_home(const ParallelRobot& robot, double drive_speed) {
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  return drive_speed / home.J_qa_x.leftCols(robot.space().translations()).rowwise().norm().maxCoeff();
}

template <auto add>
ControlLaw law(const char* name, TaskLevel level) {
  return {name,
          [level](const StageContext& site, const ReactionPorts& given) { return add(site, level, given); }};
}

}  // namespace

std::vector<ControlLaw> tracking_stages() {
  return {law<add_tracking>("velocity_tracking", TaskLevel::velocity),
          law<add_tracking>("acceleration_tracking", TaskLevel::acceleration),
          law<add_tracking>("torque_tracking", TaskLevel::torque)};
}

std::vector<ControlLaw> task_reaction_stages() {
  return {law<add_reaction>("velocity_reaction", TaskLevel::velocity),
          law<add_reaction>("acceleration_reaction", TaskLevel::acceleration),
          law<add_reaction>("torque_reaction", TaskLevel::torque),
          law<add_strict_reaction>("strict_reaction", TaskLevel::torque)};
}

void keep_constraints_strictly(const ParallelRobot& robot, ContactControlSettings& settings) {
  constexpr double speed_share = 0.58;
  const ConstraintSettings& constraints = settings.tasks.constraints;
  PoseConstraints& limits = settings.limits.limits;
  settings.limits.use = SafetyFilterSettings::Use::always;
  limits.max_condition_number = std::min(limits.max_condition_number, constraints.sigma_kappa.safety);
  limits.workspace.min_self_collision_distance =
      std::max(limits.workspace.min_self_collision_distance, constraints.sigma_sc.safety);
  const double speed = speed_share * platform_speed_at_home(robot, settings.limits.max_drive_speed);
  settings.limits.max_platform_speed = std::min(settings.limits.max_platform_speed, speed);
}

}  // namespace flinch
