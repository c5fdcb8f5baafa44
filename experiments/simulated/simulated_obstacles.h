#pragma once

#include <vector>

#include "experiments/scenario/scenario_obstacles.h"
#include "plant/obstacle.h"

namespace flinch {

class ConfigReader;

/// Reads how the obstacles of a scenario move and give way: the rest of `pylon` and `obstacles`. `seen` are
/// those that `read_obstacles` found there.
Obstacles read_simulated_obstacles(ConfigReader& scenario, const std::vector<ScenarioObstacle>& seen);

}  // namespace flinch
