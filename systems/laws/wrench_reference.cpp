#include "systems/laws/wrench_reference.h"

#include <cmath>

#include "systems/laws/task_priority.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/impedance_damping.h"

namespace flinch {
namespace {

// M_i^-1 (K_F e + D_F de), from the mobility M_i^-1 = J_i M_x^-1 J_i^T.
PlatformVector compliant_acceleration(const TaskGains& gains, const PlatformMatrix& mobility,
                                      const TaskError& error) {
  if (mobility.rows() == 1) {
    const double root = std::sqrt(gains.force[0] * mobility(0, 0));
    return mobility * gains.force.cwiseProduct(error.e) + 2.0 * gains.damping_ratio[0] * root * error.de;
  }
  const PlatformMatrix K = gains.force.asDiagonal();
  const PlatformMatrix D = impedance_damping(task_inertia(mobility), K, gains.damping_ratio).D;
  return mobility * (K * error.e + D * error.de);  // [SafePR] (44b), (46)
}

}  // namespace

TaskError error_of(const TaskGoal& goal, const PlatformVector& velocity) noexcept {
  return {goal.reference.error, goal.reference.rate - goal.task.rate(velocity)};
}

// With M_x = L L^T and u = L^T ddx the dynamically consistent projections are orthogonal ones of J L^-T.
PlatformVector wrench_reference(const TaskList& list, bool constrained, const Kinematics& kinematics,
                                const Dynamics& dynamics, const TaskLevelSettings& settings) noexcept {
  const int n = static_cast<int>(dynamics.M_x.rows());
  const Eigen::LLT<PlatformMatrix> M(dynamics.M_x);
  const PlatformMatrix L = M.matrixL();
  const bool with_drift = settings.priorities != PriorityForm::printed;  // which (44b) omits
  TaskPriority priority(n, settings.inverse, settings.priorities);
  for (const TaskGoal& goal : list) {
    if (!goal.task.valid) continue;
    const PlatformMatrix J =
        L.triangularView<Eigen::Lower>().solve(PlatformMatrix(goal.task.J.transpose())).transpose();
    const PlatformVector wanted =
        goal.reference.acceleration +
        compliant_acceleration(goal.gains, J * J.transpose(), error_of(goal, kinematics.velocity));
    priority.add(J, with_drift ? PlatformVector(wanted - goal.task.drift) : wanted);
  }
  if (constrained || settings.priorities != PriorityForm::recursive) {
    priority.add_free(-settings.free_damping * (L.transpose() * kinematics.velocity));
  } else {
    const PlatformMatrix I = PlatformMatrix::Identity(n, n);
    priority.add(L.triangularView<Eigen::Lower>().solve(I).transpose(),
                 -settings.free_damping * kinematics.velocity);
  }
  return L * priority.solution();
}

}  // namespace flinch
