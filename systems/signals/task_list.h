#pragma once

#include <array>
#include <cstddef>

#include "systems/robot/task.h"

namespace flinch {

/// How strongly a task is held on the reference, by the level on which it is controlled. One entry a row of
/// the task each. [SafePR] Table III
struct TaskGains {
  PlatformVector velocity;       ///< k of dsigma = dsigma_d + k e [1/s]
  PlatformVector stiffness;      ///< k of ddsigma = ddsigma_d + k e + d de [1/s^2]
  PlatformVector damping;        ///< d of the same [1/s]
  PlatformVector force;          ///< K_F: stiffness at the task [N/m, Nm/rad, or per unit of sigma]
  PlatformVector damping_ratio;  ///< xi of K_F, 1 is critical

  /// The same gains for each of `rows` rows.
  static TaskGains uniform(int rows, double velocity, double stiffness, double damping, double force,
                           double damping_ratio) {
    const auto all = [rows](double value) -> PlatformVector { return PlatformVector::Constant(rows, value); };
    return {all(velocity), all(stiffness), all(damping), all(force), all(damping_ratio)};
  }
  /// Those of the first row for each of `rows` rows.
  TaskGains for_rows(int rows) const {
    return uniform(rows, velocity[0], stiffness[0], damping[0], force[0], damping_ratio[0]);
  }
};

/// A task, where it shall be, and how strongly.
struct TaskGoal {
  Task task;
  TaskReference reference;
  TaskGains gains;

  /// Row `i` as a goal of its own.
  TaskGoal row(int i) const {
    const auto entry = [i](const PlatformVector& all) -> PlatformVector { return all.segment(i, 1); };
    return {along(task, PlatformVector::Unit(task.rows(), i)),
            {entry(reference.error), entry(reference.rate), entry(reference.acceleration)},
            {entry(gains.velocity), entry(gains.stiffness), entry(gains.damping), entry(gains.force),
             entry(gains.damping_ratio)}};
  }
};

/// Tasks by priority, the highest first. Without any the robot is braked.
struct TaskList {
  static constexpr std::size_t most = 4;

  std::array<TaskGoal, most> goals;
  int count = 0;
  bool valid = false;  ///< They are what shall be done now.

  /// Without effect where there is no room left.
  void add(const TaskGoal& goal) {
    if (count < static_cast<int>(most)) goals[static_cast<std::size_t>(count++)] = goal;
  }
  /// The rows of `goal` as goals of their own, the first of the highest priority.
  void add_rows(const TaskGoal& goal) {
    for (int i = 0; i < goal.task.rows(); ++i) add(goal.row(i));
  }
  const TaskGoal* begin() const { return goals.data(); }
  const TaskGoal* end() const { return goals.data() + count; }
};

}  // namespace flinch
