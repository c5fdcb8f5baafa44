#include "experiments/scenario/scenario_obstacles.h"

#include <algorithm>
#include <array>

#include "systems/config/config_reader.h"
#include "systems/robot/convex_hull.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

enum class ObstacleOutline { sphere, capsule, box, hull };

constexpr double default_radius = 0.04;  // [m]

std::span<double> entries(Eigen::Vector3d& vector) { return {vector.data(), 3}; }

ScenarioObstacle read_pylon(ConfigReader reader) {
  ScenarioObstacle pylon{.name = "pylon", .key = "pylon"};
  double radius = default_radius;
  reader.required().number("x", unit::m, pylon.position_in_base.x());
  reader.required().number("y", unit::m, pylon.position_in_base.y());
  reader.number("radius", unit::m, radius, positive);
  pylon.shape = Sphere{.radius = radius};
  return pylon;
}

/// The axes of a shape that is turned by a rotation vector against the base frame.
Eigen::Matrix3d read_axes(ConfigReader& reader) {
  Eigen::Vector3d rotation(0.0, 0.0, 0.0);
  reader.numbers("rotation", unit::rad, entries(rotation));
  return rotation_matrix(quaternion_exp(rotation));
}

Shape read_capsule(ConfigReader& reader) {
  Eigen::Vector3d axis(0.0, 0.0, 0.2);
  double radius = default_radius;
  reader.number("radius", unit::m, radius, positive);
  reader.numbers("axis", unit::m, entries(axis));
  return Capsule{.begin = -0.5 * axis, .end = 0.5 * axis, .radius = radius};
}

Shape read_box(ConfigReader& reader) {
  Eigen::Vector3d size(0.1, 0.1, 0.1);
  reader.numbers("size", unit::m, entries(size), positive);
  return Box{.axes = read_axes(reader), .half_lengths = 0.5 * size};
}

/// A sphere in the place of one that is no good.
Shape read_hull(ConfigReader& reader) {
  ConvexHull hull;
  const Eigen::Matrix3d axes = read_axes(reader);
  for (ConfigReader& corner : reader.required().sections("points")) {
    Eigen::Vector3d point(0.0, 0.0, 0.0);
    corner.required().number("x", unit::m, point.x());
    corner.required().number("y", unit::m, point.y());
    corner.required().number("z", unit::m, point.z());
    hull.points.emplace_back(axes * point);
  }
  const std::string complaint = complaint_about_points(hull);
  if (complaint.empty()) return hull;
  reader.problem("points", complaint);
  return Sphere{.radius = default_radius};
}

Shape read_shape(ConfigReader& reader) {
  ObstacleOutline outline = ObstacleOutline::sphere;
  const bool is_known = reader.choice("shape", outline,
                                      {{"sphere", ObstacleOutline::sphere},
                                       {"capsule", ObstacleOutline::capsule},
                                       {"box", ObstacleOutline::box},
                                       {"hull", ObstacleOutline::hull}});
  if (!is_known) reader.leave_rest_unread();
  switch (outline) {
    case ObstacleOutline::capsule:
      return read_capsule(reader);
    case ObstacleOutline::box:
      return read_box(reader);
    case ObstacleOutline::hull:
      return read_hull(reader);
    case ObstacleOutline::sphere:
      break;
  }
  double radius = default_radius;
  reader.number("radius", unit::m, radius, positive);
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
  std::size_t entry = 0;
  for (ConfigReader& reader : scenario.sections("obstacles")) {
    obstacles.push_back(read_obstacle(reader, obstacles.size() + 1));
    obstacles.back().key = "obstacles[" + std::to_string(entry++) + "]";
    const auto same = [&](const ScenarioObstacle& other) { return other.name == obstacles.back().name; };
    if (std::count_if(obstacles.begin(), obstacles.end(), same) > 1) {
      reader.problem("name", "is '" + obstacles.back().name + "', as that of another obstacle is");
    }
  }
  return obstacles;
}

}  // namespace flinch
