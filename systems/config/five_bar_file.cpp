#include "systems/config/five_bar_file.h"

#include <cstddef>
#include <span>

#include "systems/config/planar_leg_file.h"
#include "systems/config/robot_keys.h"
#include "systems/robot/five_bar.h"

namespace flinch {
namespace {

FiveBarLeg read_leg(ConfigReader& file) {
  FiveBarLeg leg;
  file.required().numbers("base_joint", unit::m, std::span<double>(leg.base_joint.data(), 2));
  read_planar_leg(file, leg);
  return leg;
}

}  // namespace

std::shared_ptr<const ParallelRobot> read_five_bar(ConfigReader& file) {
  FiveBarParameters robot;
  std::vector<ConfigReader> legs = file.required().sections("legs", robot.legs.size());
  file.text("name", robot.name);
  for (std::size_t i = 0; i < legs.size(); ++i) robot.legs[i] = read_leg(legs[i]);
  ConfigReader platform = file.required().section("platform").required();
  platform.number("mass", unit::kg, robot.platform_mass);
  platform.number("radius", unit::m, robot.platform_radius);
  file.required().number("link_radius", unit::m, robot.link_radius);
  file.number("friction_velocity", unit::rad_per_s, robot.friction_velocity);
  file.numbers("gravity", unit::m_per_s2, std::span<double>(robot.gravity.data(), 3));
  ConfigReader home = file.required().section("home_pose").required();
  home.number("x", unit::m, robot.home_pose.x());
  home.number("y", unit::m, robot.home_pose.y());

  note_problems(file, problems(robot),
                [&](const std::string& field) { return planar_name_in_file(field, legs); });
  return file.good() ? std::make_shared<const FiveBar>(robot) : nullptr;
}

}  // namespace flinch
