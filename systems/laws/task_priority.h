#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// How the inverse of a task's Jacobian gives way where the task can hardly be moved.
struct DampedInverseSettings {
  double near_singular = 0.02;  ///< epsilon: singular values below it are damped
  double damping = 0.05;        ///< lambda_0: of a singular value of zero
  double truncated = 1e-6;      ///< singular values below it count as zero
};

/// J^dagger = V diag(s / (s^2 + lambda^2)) U^T with lambda^2 = lambda_0^2 (1 - (s / epsilon)^2) for each
/// singular value s < epsilon, 0 above: the Moore-Penrose inverse of all that can be moved, and less and less
/// of the rest. Any shape, any rank.
PlatformMatrix damped_inverse(const PlatformMatrix& J, const DampedInverseSettings& settings = {}) noexcept;

/// Rates or accelerations u of the drives that serve tasks by priority: each as well as those before it leave
/// room. [SafePR] (32), (33) in the recursive form, in which a task takes into account what those before it
/// already move:
///
///   Jp_i = J_i N_i-1,   u_i = u_i-1 + Jp_i^dagger (target_i - J_i u_i-1),   N_i = N_i-1 - Jp_i^dagger Jp_i
///
/// The sum that the paper prints adds middle tasks twice, once without projection.
class TaskPriority {
 public:
  /// No task yet: u = 0 and N = I, for `n` drives.
  explicit TaskPriority(int n, const DampedInverseSettings& settings = {}) noexcept;

  /// Adds the task of the next lower priority. J has n columns, `target` one entry a row of J.
  void add(const PlatformMatrix& J, const PlatformVector& target) noexcept;

  const PlatformVector& solution() const noexcept { return solution_; }
  /// N: what moves none of the tasks so far.
  const PlatformMatrix& null_space() const noexcept { return null_space_; }

 private:
  DampedInverseSettings settings_;
  PlatformVector solution_;
  PlatformMatrix null_space_;
};

}  // namespace flinch
