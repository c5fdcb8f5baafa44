#pragma once

#include "systems/framework/system.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/constraint_state.h"
#include "systems/signals/task_energies.h"
#include "systems/signals/task_list.h"

namespace flinch {

/// The Lyapunov function of one task on the torque level [J],
///
///   V = de^T M de / 2 + e^T K_F e / 2,   M = (J M_x^-1 J^T)^-1               [SafePR] (47)
///   dV/dt = -de^T D_F de + de^T (dM/dt) de / 2 - de^T F,  F: from outside    (48)
///
/// of which the last line holds where the law gives the task the acceleration that it asks for. Not a number
/// where the task is not valid or cannot be moved.
double energy_of(const TaskGoal& goal, const Kinematics& kinematics, const Dynamics& dynamics) noexcept;

/// Tells the Lyapunov functions of what a law on the torque level serves, to be recorded. Of all tasks
/// together nothing is proven: a lower one may gain by what a higher one does.
class TaskEnergyMonitor final : public System {
 public:
  InputPort<TaskList> tasks = input<TaskList>("tasks");
  InputPort<TaskList> constraint_goals = input<TaskList>("constraint_goals");
  InputPort<ConstraintState> constraints = input<ConstraintState>("constraints");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  OutputPort<TaskEnergies> energies = output<&TaskEnergyMonitor::measure>("energies", tasks, constraint_goals,
                                                                          constraints, kinematics, dynamics);

 private:
  void measure(const TaskList& list, const TaskList& kept, const ConstraintState& state, const Kinematics& at,
               const Dynamics& model, TaskEnergies& found) const;
};

}  // namespace flinch
