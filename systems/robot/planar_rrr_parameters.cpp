#include "systems/robot/planar_rrr_parameters.h"

#include <cmath>
#include <cstddef>
#include <sstream>

#include "systems/robot/planar_leg.h"

namespace flinch {
namespace {

// Collects sentences "field is value unit; expectation".
class Findings {
 public:
  void positive(const std::string& field, double value, const char* unit) {
    if (!(std::isfinite(value) && value > 0.0)) add(field, value, unit, "it must be positive");
  }
  void not_negative(const std::string& field, double value, const char* unit) {
    if (!(std::isfinite(value) && value >= 0.0)) add(field, value, unit, "it must not be negative");
  }
  void finite(const std::string& field, double value, const char* unit) {
    if (!std::isfinite(value)) add(field, value, unit, "it must be finite");
  }
  void add(const std::string& field, double value, const char* unit, const char* expectation) {
    std::ostringstream sentence;
    sentence << field << " is " << value << ' ' << unit << "; " << expectation;
    sentences_.push_back(sentence.str());
  }
  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }

  bool none() const { return sentences_.empty(); }
  std::vector<std::string> take() { return std::move(sentences_); }

 private:
  std::vector<std::string> sentences_;
};

std::string leg_path(std::size_t index) { return "legs[" + std::to_string(index) + "]."; }

void check_friction(const std::string& path, const JointFriction& friction, Findings& findings) {
  findings.not_negative(path + ".viscous", friction.viscous, "Nm s/rad");
  findings.not_negative(path + ".coulomb", friction.coulomb, "Nm");
}

// In absolute link angles M_leg is [p1 - p2, p3 c; p3 c, p2], most nearly singular at c = +-1.
void check_inertia(const std::string& path, const PlanarRrrLeg& leg, Findings& findings) {
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

void check_leg(const std::string& path, const PlanarRrrLeg& leg, Findings& findings) {
  findings.finite(path + "base_angle", leg.base_angle, "rad");
  findings.positive(path + "base_radius", leg.base_radius, "m");
  findings.finite(path + "coupling_angle", leg.coupling_angle, "rad");
  findings.positive(path + "link1_length", leg.link1_length, "m");
  findings.positive(path + "link2_length", leg.link2_length, "m");
  if (std::abs(leg.elbow_sign) != 1)
    findings.add(path + "elbow_sign", leg.elbow_sign, "", "it must be 1 or -1");
  check_inertia(path, leg, findings);
  check_friction(path + "active_friction", leg.active_friction, findings);
  check_friction(path + "passive_friction", leg.passive_friction, findings);
}

void check_platform(const PlanarRrrParameters& robot, Findings& findings) {
  findings.positive("coupling_radius", robot.coupling_radius, "m");
  findings.positive("platform_mass", robot.platform_mass, "kg");
  findings.positive("platform_inertia", robot.platform_inertia, "kg m^2");
  findings.positive("platform_hull_radius", robot.platform_hull_radius, "m");
  findings.positive("link_radius", robot.link_radius, "m");
  findings.positive("friction_velocity", robot.friction_velocity, "rad/s");
  findings.finite("gravity[2]", robot.gravity.z(), "m/s^2");
  for (const int i : {0, 1}) {
    if (robot.gravity[i] == 0.0) continue;
    findings.add("gravity[" + std::to_string(i) + "]", robot.gravity[i], "m/s^2",
                 "it must be 0, for the plane of motion is horizontal");
  }
}

double distance_at_home(const PlanarRrrParameters& robot, const PlanarRrrLeg& leg) {
  const double coupling = robot.home_pose.z() + leg.coupling_angle;
  const Eigen::Vector2d base(leg.base_radius * std::sin(leg.base_angle),
                             -leg.base_radius * std::cos(leg.base_angle));
  const Eigen::Vector2d arm(robot.coupling_radius * std::cos(coupling),
                            robot.coupling_radius * std::sin(coupling));
  return (robot.home_pose.head<2>() + arm - base).norm();
}

void check_home(const PlanarRrrParameters& robot, Findings& findings) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const PlanarRrrLeg& leg = robot.legs[i];
    const double distance = distance_at_home(robot, leg);
    const double shortest = std::abs(leg.link1_length - leg.link2_length);
    const double longest = leg.link1_length + leg.link2_length;
    if (distance > shortest && distance < longest) continue;
    std::ostringstream sentence;
    sentence << "home_pose is out of reach of legs[" << i << "]: base and coupling joint are " << distance
             << " m apart; the links span more than " << shortest << " and less than " << longest << " m";
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

std::vector<std::string> problems(const PlanarRrrParameters& parameters) {
  Findings findings;
  if (parameters.name.empty()) findings.add("name is empty; a robot needs a name");
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    check_leg(leg_path(i), parameters.legs[i], findings);
  }
  check_platform(parameters, findings);
  for (int i = 0; i < 3; ++i) {
    findings.finite("home_pose[" + std::to_string(i) + "]", parameters.home_pose[i], i < 2 ? "m" : "rad");
  }
  if (findings.none()) check_home(parameters, findings);
  return findings.take();
}

}  // namespace flinch
