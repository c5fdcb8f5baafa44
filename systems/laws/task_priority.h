#pragma once

#include <cstdint>

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

/// How the tasks of a list add up.
enum class PriorityForm : std::uint8_t {
  recursive,  ///< A task takes into account what those before it already move.
  augmented,  ///< It is served as if it were alone, and projected.
  printed,    ///< As in [SafePR] (32a), (33a), (44a).
};

/// Rates or accelerations u of the drives that serve tasks by priority: each as well as those before it leave
/// room. With N_i = I - J_A,i^dagger J_A,i of the first i tasks, which move nothing of them, N_0 = I:
///
///   recursive   u_i = u_i-1 + (J_i N_i-1)^dagger (target_i - J_i u_i-1): all that can be served are exact
///   augmented   u = sum over i of N_i-1 J_i^dagger target_i: the first is exact, those below are nearly so
///   printed     u = sum over i < n of J_i^dagger target_i + N_i J_i+1^dagger target_i+1: of three tasks and
///               more all but the first and the last are added twice, once without projection, and the first
///               is not exact any more; a single task is served alone. [SafePR] (32a), (32c), (32d), (33a)
class TaskPriority {
 public:
  /// No task yet: u = 0 and N = I, for `n` drives.
  explicit TaskPriority(int n, const DampedInverseSettings& settings = {},
                        PriorityForm form = PriorityForm::recursive) noexcept;

  /// Adds the task of the next lower priority. J has n columns, `target` one entry a row of J.
  void add(const PlatformMatrix& J, const PlatformVector& target) noexcept;
  /// Adds `target` in what the tasks leave free, which no form counts twice.
  void add_free(const PlatformVector& target) noexcept;

  const PlatformVector& solution() const noexcept { return solution_; }
  /// N: what moves none of the tasks so far.
  const PlatformMatrix& null_space() const noexcept { return null_space_; }

 private:
  /// What J^dagger target of the next task adds to the printed sum.
  PlatformVector printed(const PlatformVector& alone) noexcept;

  DampedInverseSettings settings_;
  PriorityForm form_;
  PlatformVector solution_;
  PlatformMatrix null_space_;
  PlatformVector middle_;   ///< J^dagger target of the last task, where it is not the first.
  bool has_first_ = false;  ///< A task was added.
};

}  // namespace flinch
