#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "systems/robot/body.h"

namespace flinch {

class ConfigReader;

/// Something beside the robot that may be touched.
struct ScenarioObstacle {
  std::string name;
  std::string key = {};  ///< of its section in the scenario: "pylon", "obstacles[0]"
  Eigen::Vector3d position_in_base{0.0, 0.0, 0.0};  ///< Before anything touches or moves it [m].
  Shape shape = Sphere{.radius = 0.04};             ///< About its position.
};

/// Reads where the obstacles stand and what they look like: the section `pylon` and the list `obstacles` of a
/// scenario, of which the pylon comes first. How they move and give way is for a simulation to read.
std::vector<ScenarioObstacle> read_obstacles(ConfigReader& scenario);

}  // namespace flinch
