#include "systems/config/planar_rrr_file.h"

#include <cstddef>
#include <span>

#include "systems/config/planar_leg_file.h"
#include "systems/config/robot_keys.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

PlanarRrrLeg read_leg(ConfigReader& file) {
  PlanarRrrLeg leg;
  read_planar_leg(file, leg);
  file.required().number("base_radius", unit::m, leg.base_radius);
  file.required().number("coupling_angle", unit::rad, leg.coupling_angle);
  return leg;
}

void read_platform(const ConfigReader& platform, PlanarRrrParameters& robot) {
  ConfigReader required = platform.required();
  required.number("coupling_radius", unit::m, robot.coupling_radius);
  required.number("mass", unit::kg, robot.platform_mass);
  required.number("inertia", unit::kg_m2, robot.platform_inertia);
  required.number("hull_radius", unit::m, robot.platform_hull_radius);
}

}  // namespace

std::shared_ptr<const ParallelRobot> read_planar_rrr(ConfigReader& file) {
  PlanarRrrParameters robot;
  std::vector<ConfigReader> legs = file.required().sections("legs", robot.legs.size());
  file.text("name", robot.name);
  for (std::size_t i = 0; i < legs.size(); ++i) robot.legs[i] = read_leg(legs[i]);
  read_platform(file.required().section("platform"), robot);
  file.required().number("link_radius", unit::m, robot.link_radius);
  file.number("friction_velocity", unit::rad_per_s, robot.friction_velocity);
  file.numbers("gravity", unit::m_per_s2, std::span<double>(robot.gravity.data(), 3));
  ConfigReader home = file.section("home_pose");
  home.number("x", unit::m, robot.home_pose.x());
  home.number("y", unit::m, robot.home_pose.y());
  home.number("phi", unit::rad, robot.home_pose.z());

  note_problems(file, problems(robot), [&](const std::string& field) {
    return field == "coupling_radius" ? "platform.coupling_radius" : planar_name_in_file(field, legs);
  });
  return file.good() ? std::make_shared<const PlanarRrr>(robot) : nullptr;
}

}  // namespace flinch
