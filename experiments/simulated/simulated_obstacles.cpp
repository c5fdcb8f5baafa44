#include "experiments/simulated/simulated_obstacles.h"

#include <optional>
#include <span>

#include "plant/compliant_obstacle.h"
#include "plant/hand.h"
#include "plant/obstacle_path.h"
#include "systems/config/config_reader.h"

namespace flinch {
namespace {

enum class Kind { fixed, compliant, path, hand };

void read_material(ConfigReader& reader, ContactMaterial& material) {
  reader.number("stiffness", unit::N_per_m, material.stiffness, positive);
  reader.number("restitution", unit::none, material.restitution,
                {.low = 0.0, .high = 1.0, .low_included = false});
  reader.number("restitution_speed", unit::m_per_s, material.restitution_speed, positive);
  reader.number("friction", unit::none, material.friction, not_negative);
}

CompliantMount read_mount(ConfigReader& reader) {
  CompliantMount mount;
  reader.number("mass", unit::kg, mount.mass, positive);
  reader.number("mount_stiffness", unit::N_per_m, mount.stiffness, positive);
  reader.number("mount_damping", unit::Ns_per_m, mount.damping, not_negative);
  return mount;
}

ObstaclePath read_path(ConfigReader& reader) {
  std::vector<PathPoint> points;
  for (ConfigReader& place : reader.sections("path")) {
    PathPoint point;
    place.required().number("time", unit::s, point.time, not_negative);
    place.number("x", unit::m, point.displacement.x());
    place.number("y", unit::m, point.displacement.y());
    place.number("z", unit::m, point.displacement.z());
    points.push_back(point);
  }
  return ObstaclePath(std::move(points));
}

std::optional<Grip> read_grip(ConfigReader& reader) {
  if (!reader.has("grip")) return std::nullopt;
  Grip grip;
  ConfigReader section = reader.section("grip");
  section.required().number("begin", unit::s, grip.times.begin, not_negative);
  section.required().number("end", unit::s, grip.times.end, not_negative);
  section.number("stiffness", unit::N_per_m, grip.stiffness, positive);
  section.number("damping", unit::Ns_per_m, grip.damping, not_negative);
  return grip;
}

std::shared_ptr<const Obstacle> read_obstacle(ConfigReader& reader, Kind kind, const ObstacleForm& form) {
  switch (kind) {
    case Kind::compliant:
      return std::make_shared<const CompliantObstacle>(form, read_mount(reader));
    case Kind::path:
      return std::make_shared<const MovingObstacle>(form, read_path(reader));
    case Kind::hand: {
      const CompliantMount arm = read_mount(reader);
      return std::make_shared<const Hand>(form, arm, read_path(reader), read_grip(reader));
    }
    case Kind::fixed:
      break;
  }
  return std::make_shared<const FixedObstacle>(form);
}

ObstacleForm form_of(const ScenarioObstacle& seen) {
  return {.name = seen.name, .shape = seen.shape, .position_in_base = seen.position_in_base};
}

}  // namespace

Obstacles read_simulated_obstacles(ConfigReader& scenario, const std::vector<ScenarioObstacle>& seen) {
  Obstacles obstacles;
  const auto read = [&](ConfigReader reader, const char* key, bool moves) {
    ObstacleForm form = form_of(seen[obstacles.size()]);
    read_material(reader, form.material);
    Kind kind = Kind::fixed;
    if (moves) {
      const bool is_known = reader.choice(key, kind,
                                          {{"fixed", Kind::fixed},
                                           {"compliant", Kind::compliant},
                                           {"path", Kind::path},
                                           {"hand", Kind::hand}});
      if (!is_known) reader.leave_rest_unread();
    } else {
      reader.choice(key, kind, {{"fixed", Kind::fixed}, {"compliant", Kind::compliant}});
      read_mount(reader);
    }
    obstacles.push_back(read_obstacle(reader, kind, form));
    for (const std::string& complaint : obstacles.back()->problems("")) reader.problem("", complaint);
  };
  if (scenario.has("pylon")) read(scenario.section("pylon"), "mounting", false);
  for (ConfigReader& reader : scenario.sections("obstacles")) read(reader, "kind", true);
  if (obstacles.size() > max_obstacles) {
    scenario.problem("obstacles", "has " + std::to_string(obstacles.size()) +
                                      " entries with the pylon; at most " + std::to_string(max_obstacles) +
                                      " can be simulated");
  }
  return obstacles;
}

}  // namespace flinch
