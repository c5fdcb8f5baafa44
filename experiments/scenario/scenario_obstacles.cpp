#include "experiments/scenario/scenario_obstacles.h"

#include <algorithm>
#include <array>

#include "systems/config/config_reader.h"

namespace flinch {
namespace {

enum class Outline { sphere, capsule, box };

std::span<double> entries(Eigen::Vector3d& vector) { return {vector.data(), 3}; }

ScenarioObstacle read_pylon(ConfigReader reader) {
  ScenarioObstacle pylon{.name = "pylon"};
  double radius = 0.04;
  reader.required().number("x", unit::m, pylon.position_in_base.x());
  reader.required().number("y", unit::m, pylon.position_in_base.y());
  reader.number("radius", unit::m, radius, positive);
  pylon.shape = Sphere{.radius = radius};
  return pylon;
}

Shape read_shape(ConfigReader& reader) {
  Outline outline = Outline::sphere;
  double radius = 0.04;
  Eigen::Vector3d axis(0.0, 0.0, 0.2), size(0.1, 0.1, 0.1);
  const bool is_known = reader.choice(
      "shape", outline, {{"sphere", Outline::sphere}, {"capsule", Outline::capsule}, {"box", Outline::box}});
  if (!is_known) reader.leave_rest_unread();
  if (outline != Outline::box) reader.number("radius", unit::m, radius, positive);
  if (outline == Outline::capsule) reader.numbers("axis", unit::m, entries(axis));
  if (outline == Outline::box) reader.numbers("size", unit::m, entries(size), positive);
  switch (outline) {
    case Outline::capsule:
      return Capsule{.begin = -0.5 * axis, .end = 0.5 * axis, .radius = radius};
    case Outline::box:
      return Box{.half_lengths = 0.5 * size};
    case Outline::sphere:
      break;
  }
  return Sphere{.radius = radius};
}

ScenarioObstacle read_obstacle(ConfigReader reader, std::size_t number) {
  ScenarioObstacle obstacle{.name = "obstacle " + std::to_string(number)};
  reader.text("name", obstacle.name);
  reader.required().number("x", unit::m, obstacle.position_in_base.x());
  reader.required().number("y", unit::m, obstacle.position_in_base.y());
  reader.number("z", unit::m, obstacle.position_in_base.z());
  obstacle.shape = read_shape(reader);
  return obstacle;
}

}  // namespace

std::vector<ScenarioObstacle> read_obstacles(ConfigReader& scenario) {
  std::vector<ScenarioObstacle> obstacles;
  if (scenario.has("pylon")) obstacles.push_back(read_pylon(scenario.section("pylon")));
  for (ConfigReader& reader : scenario.sections("obstacles")) {
    obstacles.push_back(read_obstacle(reader, obstacles.size() + 1));
    const auto same = [&](const ScenarioObstacle& other) { return other.name == obstacles.back().name; };
    if (std::count_if(obstacles.begin(), obstacles.end(), same) > 1) {
      reader.problem("name", "is '" + obstacles.back().name + "', as that of another obstacle is");
    }
  }
  return obstacles;
}

}  // namespace flinch
