#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/laws/task_level.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/constraint_state.h"
#include "systems/signals/torque_command.h"

namespace flinch {

struct TaskControllerSettings {
  TaskLevel level = TaskLevel::torque;
  TaskLevelSettings levels;
  Time blend = 10ms;  ///< from the tasks of one constraint mode to those of the next, 0 for none
};

/// Serves a list of tasks by priority on one level, constraints before them as the constraint mode says
/// ([SafePR] Alg. 3). Torques change no faster than the largest rate, in the direction of the change. Where
/// that mode changes, the reference of the level is blended: old and new tasks are both evaluated, w grows by
/// tick / blend. A change while another is blended in goes on from what was last handed on. Not valid where
/// kinematics, dynamics or the list are not.
class TaskController final : public System {
 public:
  /// How far the change from one constraint mode to the next has come.
  struct Blend {
    Time tick{};
    ConstraintMode from = ConstraintMode::none;
    ConstraintMode to = ConstraintMode::none;
    Time progress = 1h;
    double weight = 1.0;       ///< of `to`
    bool frozen = false;       ///< blending from `held` instead of the tasks of `from`
    PlatformVector held;       ///< a reference of the level
    PlatformVector reference;  ///< what is handed on; empty where there is none
  };

 private:
  State<Blend> last_ = state<Blend>("last");
  State<TorqueCommand> last_torque_ = state<TorqueCommand>("last_torque");

 public:
  /// Throws SetupError for settings that are not positive.
  TaskController(std::shared_ptr<const ParallelRobot> robot, const TaskControllerSettings& settings);

  InputPort<TaskList> tasks = input<TaskList>("tasks");
  InputPort<TaskList> constraint_goals = input<TaskList>("constraint_goals");
  InputPort<ConstraintState> constraints = input<ConstraintState>("constraints");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");

 private:
  Intermediate<Blend> blend_ = intermediate<&TaskController::blend>(
      "blend", clock, last_, tasks, constraint_goals, constraints, kinematics, dynamics);

 public:
  OutputPort<TorqueCommand> torque =
      output<&TaskController::drive>("torque", clock, last_torque_, blend_, kinematics, dynamics);

 private:
  Update remember_ = keep(last_, blend_);
  Update remember_torque_ = keep(last_torque_, torque);

  void blend(Time now, const Blend& last, const TaskList& list, const TaskList& kept,
             const ConstraintState& state, const Kinematics& at, const Dynamics& model, Blend& next) const;
  void drive(Time now, const TorqueCommand& last, const Blend& wanted, const Kinematics& at,
             const Dynamics& model, TorqueCommand& command) const;
  Blend advanced(Time now, const Blend& last, ConstraintMode wanted) const;

  std::shared_ptr<const ParallelRobot> robot_;
  TaskControllerSettings settings_;
};

}  // namespace flinch
