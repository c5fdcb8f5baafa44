#include "systems/config/hexapod_file.h"

#include <cstddef>
#include <span>

#include "systems/config/robot_keys.h"
#include "systems/robot/hexapod.h"

namespace flinch {
namespace {

std::span<double> entries(Eigen::Vector3d& v) { return {v.data(), 3}; }

/// `common` has what is equal in all legs.
HexapodLeg read_leg(ConfigReader file, const HexapodLeg& common) {
  HexapodLeg leg = common;
  ConfigReader required = file.required();
  required.numbers("base_joint", unit::m, entries(leg.base_joint));
  required.numbers("platform_joint", unit::m, entries(leg.platform_joint));
  required.numbers("universal_axis", unit::none, entries(leg.universal_axis));
  leg.universal_axis.normalize();
  if (file.has("drive_friction")) leg.drive_friction = read_sliding_friction(file.section("drive_friction"));
  if (file.has("universal_friction"))
    leg.universal_friction = read_friction(file.section("universal_friction"));
  return leg;
}

RigidBodyInertia read_body(ConfigReader& file) {
  RigidBodyInertia body;
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  ConfigReader required = file.required();
  required.number("mass", unit::kg, body.mass);
  required.numbers("centre_of_mass", unit::m, entries(body.centre_of_mass));
  required.numbers("inertia", unit::kg_m2, entries(moments));
  file.numbers("inertia_products", unit::kg_m2, entries(products));
  const auto [xy, xz, yz] = std::tuple(products[0], products[1], products[2]);
  body.inertia << moments[0], xy, xz, xy, moments[1], yz, xz, yz, moments[2];
  return body;
}

void read_links(ConfigReader& file, HexapodParameters& robot) {
  ConfigReader cylinder = file.required().section("cylinder");
  cylinder.required().number("length", unit::m, robot.cylinder_length);
  cylinder.required().number("radius", unit::m, robot.cylinder_radius);
  robot.cylinder = read_body(cylinder);
  ConfigReader rod = file.required().section("rod");
  rod.required().number("length", unit::m, robot.rod_length);
  rod.required().number("radius", unit::m, robot.rod_radius);
  robot.rod = read_body(rod);
}

void read_joints(ConfigReader& file, HexapodParameters& robot) {
  file.number("drive_armature", unit::kg, robot.drive_armature);
  file.number("drive_friction_velocity", unit::m_per_s, robot.drive_friction_velocity);
  file.number("universal_friction_velocity", unit::rad_per_s, robot.universal_friction_velocity);
}

void read_platform(ConfigReader platform, HexapodParameters& robot) {
  robot.platform = read_body(platform);
  ConfigReader required = platform.required();
  required.number("radius", unit::m, robot.platform_radius);
  required.number("bottom", unit::m, robot.platform_bottom);
  required.number("top", unit::m, robot.platform_top);
}

void read_home(ConfigReader home, HexapodParameters& robot) {
  home.number("x", unit::m, robot.home_position.x());
  home.number("y", unit::m, robot.home_position.y());
  home.required().number("z", unit::m, robot.home_position.z());
  home.numbers("rotation", unit::rad, entries(robot.home_rotation));
}

// Name in the file of a field of HexapodParameters.
std::string name_in_file(std::string field) {
  if (field == "home_position" || field == "home_rotation") return "home_pose";
  for (const std::string section : {"platform", "cylinder", "rod"}) {
    if (field.starts_with(section + "_")) return field.replace(section.size(), 1, ".");
  }
  return field;
}

}  // namespace

std::shared_ptr<const ParallelRobot> read_hexapod(ConfigReader& file) {
  HexapodParameters robot;
  const std::vector<ConfigReader> legs = file.required().sections("legs", robot.legs.size());
  file.text("name", robot.name);
  HexapodLeg common;
  common.drive_friction = read_sliding_friction(file.section("drive_friction"));
  common.universal_friction = read_friction(file.section("universal_friction"));
  for (std::size_t i = 0; i < legs.size(); ++i) robot.legs[i] = read_leg(legs[i], common);
  read_links(file, robot);
  read_joints(file, robot);
  read_platform(file.required().section("platform"), robot);
  if (file.has("payload")) {
    ConfigReader payload = file.section("payload");
    robot.payload = read_body(payload);
  }
  file.required().number("characteristic_length", unit::m, robot.characteristic_length);
  file.numbers("gravity", unit::m_per_s2, entries(robot.gravity));
  read_home(file.required().section("home_pose"), robot);

  note_problems(file, problems(robot), name_in_file);
  return file.good() ? std::make_shared<const Hexapod>(robot) : nullptr;
}

}  // namespace flinch
