#include "systems/config/planar_leg_file.h"

#include <cstddef>

#include "systems/config/robot_keys.h"

namespace flinch {
namespace {

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

}  // namespace

void read_planar_leg(ConfigReader& file, PlanarLegParameters& leg) {
  ConfigReader required = file.required();
  required.number("base_angle", unit::rad, leg.base_angle);
  required.number("link1_length", unit::m, leg.link1_length);
  required.number("link2_length", unit::m, leg.link2_length);
  file.integer("elbow_sign", leg.elbow_sign);
  leg.inertia = read_inertia(file, leg.link1_length);
  file.number("rotor_inertia", unit::kg_m2, leg.rotor_inertia);
  leg.active_friction = read_friction(file.section("active_friction"));
  leg.passive_friction = read_friction(file.section("passive_friction"));
}

std::string planar_name_in_file(std::string field, const std::vector<ConfigReader>& legs) {
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const std::string leg = "legs[" + std::to_string(i) + "].";
    const std::string inertia = leg + "inertia";
    if (!field.starts_with(inertia)) continue;
    const bool as_bodies = legs[i].has("bodies") && !legs[i].has("base_parameters");
    return field.replace(0, inertia.size(), leg + (as_bodies ? "bodies" : "base_parameters"));
  }
  const std::string platform = "platform_";
  if (field.starts_with(platform)) return field.replace(0, platform.size(), "platform.");
  return field;
}

}  // namespace flinch
