#pragma once

#include <array>

#include "systems/robot/task.h"

namespace flinch {

/// What keeps links apart by smooth functions, without plateau and ties: links are at least some distance
/// apart exactly where none of these tasks exceeds `largest`.
struct SelfCollisionTasks {
  std::array<Task, max_dof> tasks;
  int count = 0;
  double largest = 0.0;  ///< In the unit of the tasks.
};

}  // namespace flinch
