#include "systems/laws/task_energy.h"

#include <cmath>
#include <limits>

#include "systems/laws/task_level.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

using Inertia = Eigen::LLT<PlatformMatrix>;  // M_x

double energy_with(const Inertia& M_x, const TaskGoal& goal, const Kinematics& at) {
  if (!goal.task.valid) return std::numeric_limits<double>::quiet_NaN();
  const PlatformMatrix& J = goal.task.J;
  const PlatformMatrix M = task_inertia(J * M_x.solve(PlatformMatrix(J.transpose())));
  const PlatformVector& e = goal.reference.error;
  const PlatformVector de = goal.reference.rate - goal.task.rate(at.velocity);
  return 0.5 * de.dot(M * de) + 0.5 * e.dot(goal.gains.force.cwiseProduct(e));
}

void note(const TaskGoal& goal, int number, const Kinematics& at, const Inertia& M_x, TaskEnergies& found) {
  if (number >= TaskEnergies::most) return;
  const double energy = energy_with(M_x, goal, at);
  if (!std::isfinite(energy)) return;
  found.served |= 1U << static_cast<unsigned>(number);
  found.energy[static_cast<std::size_t>(number)] = energy;
}

}  // namespace

double energy_of(const TaskGoal& goal, const Kinematics& kinematics, const Dynamics& dynamics) noexcept {
  return energy_with(Inertia(dynamics.M_x), goal, kinematics);
}

void TaskEnergyMonitor::measure(const TaskList& list, const TaskList& kept, const ConstraintState& state,
                                const Kinematics& at, const Dynamics& model, TaskEnergies& found) const {
  found = {};
  if (!list.valid || !at.valid || !model.valid) return;
  found.valid = true;
  const Inertia M_x(model.M_x);
  if (kept.count >= 2 && state.sigma_kappa.active) note(kept.goals[0], 0, at, M_x, found);
  if (kept.count >= 2 && state.sigma_sc.active) note(kept.goals[1], 1, at, M_x, found);
  int number = 2;
  for (const TaskGoal& goal : list) note(goal, number++, at, M_x, found);
}

}  // namespace flinch
