#include "systems/robot/planar_leg_parameters.h"

#include <cmath>
#include <sstream>

namespace flinch {
namespace {

// In absolute link angles M_leg is [p1 - p2, p3 c; p3 c, p2], most nearly singular at c = +-1.
void check_inertia(const std::string& path, const PlanarLegParameters& leg, Findings& findings) {
  findings.not_negative(path + "rotor_inertia", leg.rotor_inertia, "kg m^2");
  findings.positive(path + "inertia.p1", leg.inertia.p1, "kg m^2");
  findings.positive(path + "inertia.p2", leg.inertia.p2, "kg m^2");
  findings.not_negative(path + "inertia.p3", leg.inertia.p3, "kg m^2");
  const auto [p1, p2, p3] = leg.inertia;
  if (p1 > 0.0 && p2 > 0.0 && p3 >= 0.0 && !(p1 > p2 && (p1 - p2) * p2 > p3 * p3)) {
    std::ostringstream sentence;
    sentence << path << "inertia has (p1 - p2) p2 = " << (p1 - p2) * p2 << " and p3^2 = " << p3 * p3
             << " kg^2 m^4; the first must be greater, or the mass matrix is not positive definite";
    findings.add(sentence.str());
  }
}

}  // namespace

LegInertia base_parameters(const LinkBody& link1, const LinkBody& link2, double link1_length) {
  const double s1 = link1.centre_of_mass;
  const double s2 = link2.centre_of_mass;
  const double p2 = link2.mass * s2 * s2 + link2.inertia;
  const double p1 = link1.inertia + link1.mass * s1 * s1 + link2.mass * link1_length * link1_length + p2;
  return {.p1 = p1, .p2 = p2, .p3 = link2.mass * link1_length * s2};
}

void add_links(const PlanarLegParameters& leg, double link_radius, std::vector<Body>& bodies) {
  const int index = BodyId::from_index(static_cast<int>(bodies.size())).leg();
  const auto add = [&](BodyId body, double length) {
    const Capsule outline{.end = length * Eigen::Vector3d::UnitX(), .radius = link_radius};
    bodies.push_back({body_name(body), index, {outline}});
  };
  add(BodyId::link1(index), leg.link1_length);
  add(BodyId::link2(index), leg.link2_length);
}

void find_problems(const std::string& path, const PlanarLegParameters& leg, Findings& findings) {
  findings.finite(path + "base_angle", leg.base_angle, "rad");
  findings.positive(path + "link1_length", leg.link1_length, "m");
  findings.positive(path + "link2_length", leg.link2_length, "m");
  if (std::abs(leg.elbow_sign) != 1) findings.add(path + "elbow_sign", leg.elbow_sign, "", "must be 1 or -1");
  check_inertia(path, leg, findings);
  find_friction_problems(path + "active_friction", leg.active_friction, findings);
  find_friction_problems(path + "passive_friction", leg.passive_friction, findings);
}

void find_gravity_problems(const Eigen::Vector3d& gravity, Findings& findings) {
  findings.finite("gravity[2]", gravity.z(), "m/s^2");
  for (const int i : {0, 1}) {
    if (gravity[i] == 0.0) continue;
    findings.add("gravity[" + std::to_string(i) + "]", gravity[i], "m/s^2",
                 "must be 0, for the plane of motion is horizontal");
  }
}

void find_reach_problem(std::size_t index, const PlanarLegParameters& leg, double distance,
                        Findings& findings) {
  const double shortest = std::abs(leg.link1_length - leg.link2_length);
  const double longest = leg.link1_length + leg.link2_length;
  if (distance > shortest && distance < longest) return;
  std::ostringstream sentence;
  sentence << "home_pose is out of reach of legs[" << index << "]: base and coupling joint are " << distance
           << " m apart; the links span more than " << shortest << " and less than " << longest << " m";
  findings.add(sentence.str());
}

}  // namespace flinch
