#include "systems/config/robot_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "systems/config/config_reader.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

/// Mechanisms that a file can describe.
enum class RobotKind { planar_3rrr };

struct PlanarRrrFile {
  std::shared_ptr<const PlanarRrr> robot;
  WorkspaceLimits limits;
  std::vector<ReadValue> values;
};

JointFriction read_friction(ConfigReader file) {
  JointFriction friction;
  file.number("viscous", unit::Nms_per_rad, friction.viscous);
  file.number("coulomb", unit::Nm, friction.coulomb);
  return friction;
}

LinkBody read_body(const ConfigReader& file) {
  LinkBody body;
  ConfigReader required = file.required();
  required.number("mass", unit::kg, body.mass, positive);
  required.number("centre_of_mass", unit::m, body.centre_of_mass);
  required.number("inertia", unit::kg_m2, body.inertia, not_negative);
  return body;
}

LegInertia read_inertia(ConfigReader& leg, double link1_length) {
  LegInertia inertia;
  if (leg.one_of({"base_parameters", "bodies"}) == "bodies") {
    ConfigReader bodies = leg.section("bodies").required();
    const LinkBody link1 = read_body(bodies.section("link1"));
    const LinkBody link2 = read_body(bodies.section("link2"));
    return base_parameters(link1, link2, link1_length);
  }
  ConfigReader required = leg.section("base_parameters").required();
  required.number("p1", unit::kg_m2, inertia.p1);
  required.number("p2", unit::kg_m2, inertia.p2);
  required.number("p3", unit::kg_m2, inertia.p3);
  return inertia;
}

PlanarRrrLeg read_leg(ConfigReader& file) {
  PlanarRrrLeg leg;
  ConfigReader required = file.required();
  required.number("base_angle", unit::rad, leg.base_angle);
  required.number("base_radius", unit::m, leg.base_radius);
  required.number("coupling_angle", unit::rad, leg.coupling_angle);
  required.number("link1_length", unit::m, leg.link1_length);
  required.number("link2_length", unit::m, leg.link2_length);
  file.integer("elbow_sign", leg.elbow_sign);
  leg.inertia = read_inertia(file, leg.link1_length);
  file.number("rotor_inertia", unit::kg_m2, leg.rotor_inertia);
  leg.active_friction = read_friction(file.section("active_friction"));
  leg.passive_friction = read_friction(file.section("passive_friction"));
  return leg;
}

void read_platform(const ConfigReader& platform, PlanarRrrParameters& robot) {
  ConfigReader required = platform.required();
  required.number("coupling_radius", unit::m, robot.coupling_radius);
  required.number("mass", unit::kg, robot.platform_mass);
  required.number("inertia", unit::kg_m2, robot.platform_inertia);
  required.number("hull_radius", unit::m, robot.platform_hull_radius);
}

PlanarRrrParameters read_parameters(ConfigReader& file, std::vector<ConfigReader>& legs) {
  PlanarRrrParameters robot;
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
  return robot;
}

WorkspaceLimits read_limits(ConfigReader file) {
  WorkspaceLimits limits;
  file.number("max_distance", unit::m, limits.max_distance);
  file.number("max_rotation", unit::rad, limits.max_rotation);
  file.number("min_abs_det_A", unit::none, limits.min_abs_det_A);
  file.number("min_abs_det_B", unit::none, limits.min_abs_det_B);
  file.number("min_self_collision_distance", unit::m, limits.min_self_collision_distance);
  file.number("min_active_angle", unit::rad, limits.min_active);
  file.number("max_active_angle", unit::rad, limits.max_active);
  return limits;
}

// ---------------------------------------------------------------- what does not fit together

// Name in the file of a field of PlanarRrrParameters.
std::string name_in_file(std::string field, const std::vector<ConfigReader>& legs) {
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const std::string leg = "legs[" + std::to_string(i) + "].";
    const std::string inertia = leg + "inertia";
    if (!field.starts_with(inertia)) continue;
    const bool as_bodies = legs[i].has("bodies") && !legs[i].has("base_parameters");
    return field.replace(0, inertia.size(), leg + (as_bodies ? "bodies" : "base_parameters"));
  }
  const std::string platform = "platform_";
  if (field == "coupling_radius") return "platform.coupling_radius";
  if (field.starts_with(platform)) return field.replace(0, platform.size(), "platform.");
  return field;
}

// A sentence about a field, "platform_mass is -1 kg; ...", as its first word and the rest.
std::pair<std::string, std::string> split_sentence(const std::string& sentence) {
  const std::size_t blank = sentence.find(' ');
  return {sentence.substr(0, blank), sentence.substr(blank + 1)};
}

PlanarRrrFile read_planar_rrr(ConfigReader file) {
  std::vector<ConfigReader> legs = file.required().sections("legs", 3);
  const PlanarRrrParameters parameters = read_parameters(file, legs);
  ConfigReader limits_section = file.section("workspace_limits");
  PlanarRrrFile result;
  result.limits = read_limits(limits_section);

  for (const std::string& sentence : problems(parameters)) {
    const auto [field, complaint] = split_sentence(sentence);
    file.problem(name_in_file(field, legs), complaint);
  }
  if (file.good()) {
    result.robot = std::make_shared<const PlanarRrr>(parameters);
    for (const std::string& sentence : problems(result.limits, *result.robot)) {
      const auto [field, complaint] = split_sentence(sentence);
      limits_section.problem(field, complaint);
    }
  }
  result.values = file.finish();
  return result;
}

PlanarRrrFile read_any(const ConfigReader& file) {
  RobotKind kind = RobotKind::planar_3rrr;
  file.required().choice("kind", kind, {{"planar_3rrr", RobotKind::planar_3rrr}});
  return read_planar_rrr(file);
}

PlanarRrrFile read_file(const std::filesystem::path& path) { return read_any(ConfigReader::open(path)); }

RobotFile of_any_kind(PlanarRrrFile read) {
  return {std::move(read.robot), read.limits, std::move(read.values)};
}

}  // namespace

RobotFile read_robot_file(const std::filesystem::path& file) { return of_any_kind(read_file(file)); }

RobotFile parse_robot_file(std::string_view text, const std::string& file) {
  return of_any_kind(read_any(ConfigReader::parse(text, file)));
}

std::shared_ptr<const ParallelRobot> load_robot(const std::filesystem::path& file) {
  return read_file(file).robot;
}

PlanarRrrParameters load_planar_rrr(const std::filesystem::path& file) {
  return read_file(file).robot->parameters();
}

}  // namespace flinch
