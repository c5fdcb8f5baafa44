#pragma once

#include "systems/signals/task_list.h"

namespace flinch {

struct PoseGoalSettings {
  /// [SafePR] Table III, the same for every direction.
  TaskGains position = TaskGains::uniform(1, 30.0, 2000.0, 50.0, 2000.0, 1.0);
  TaskGains orientation = TaskGains::uniform(1, 40.0, 2500.0, 75.0, 85.0, 1.0);
};

}  // namespace flinch
