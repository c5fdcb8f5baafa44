#include "systems/laws/task_priority.h"

#include <cmath>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

// Of a singular value with the square `squared`: s / (s^2 + lambda^2), over s.
double inverse_square(double squared, const DampedInverseSettings& settings) {
  if (!(squared > settings.truncated * settings.truncated)) return 0.0;
  const double ratio = squared / (settings.near_singular * settings.near_singular);
  const double lambda_squared = ratio < 1.0 ? settings.damping * settings.damping * (1.0 - ratio) : 0.0;
  return 1.0 / (squared + lambda_squared);
}

}  // namespace

// From the eigenvectors U of J J^T: V = J^T U / s.
PlatformMatrix damped_inverse(const PlatformMatrix& J, const DampedInverseSettings& settings) noexcept {
  if (J.rows() == 1) return J.transpose() * inverse_square(J.squaredNorm(), settings);
  const PlatformMatrix squared = J * J.transpose();
  const Eigen::SelfAdjointEigenSolver<PlatformMatrix> system(squared);
  const PlatformMatrix& U = system.eigenvectors();
  const PlatformVector inverses =
      system.eigenvalues().unaryExpr([&](double s) { return inverse_square(s, settings); });
  return J.transpose() * (U * inverses.asDiagonal() * U.transpose());
}

TaskPriority::TaskPriority(int n, const DampedInverseSettings& settings, PriorityForm form) noexcept
    : settings_(settings),
      form_(form),
      solution_(PlatformVector::Zero(n)),
      null_space_(PlatformMatrix::Identity(n, n)),
      middle_(PlatformVector::Zero(n)) {}

void TaskPriority::add(const PlatformMatrix& J, const PlatformVector& target) noexcept {
  const PlatformMatrix J_p = J * null_space_;
  const PlatformMatrix inverse = damped_inverse(J_p, settings_);
  if (form_ == PriorityForm::recursive) {
    solution_ += inverse * (target - J * solution_);
  } else {
    const PlatformVector alone = damped_inverse(J, settings_) * target;
    solution_ += form_ == PriorityForm::augmented ? null_space_ * alone : printed(alone);
  }
  null_space_ -= inverse * J_p;
}

// Term i of the sum has task i as it is and task i + 1 projected: the task before the next is a middle one.
PlatformVector TaskPriority::printed(const PlatformVector& alone) noexcept {
  const PlatformVector added = middle_ + null_space_ * alone;
  if (has_first_) middle_ = alone;
  has_first_ = true;
  return added;
}

void TaskPriority::add_free(const PlatformVector& target) noexcept {
  if (form_ == PriorityForm::recursive) {
    add(PlatformMatrix::Identity(target.size(), target.size()), target);
  } else {
    solution_ += null_space_ * target;
  }
}

}  // namespace flinch
