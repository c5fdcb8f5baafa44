#include "systems/robot/planar_rrr_parameters.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace flinch {
namespace {

void check_leg(const std::string& path, const PlanarRrrLeg& leg, Findings& findings) {
  find_problems(path, leg, findings);
  findings.positive(path + "base_radius", leg.base_radius, "m");
  findings.finite(path + "coupling_angle", leg.coupling_angle, "rad");
}

void check_platform(const PlanarRrrParameters& robot, Findings& findings) {
  findings.positive("coupling_radius", robot.coupling_radius, "m");
  findings.positive("platform_mass", robot.platform_mass, "kg");
  findings.positive("platform_inertia", robot.platform_inertia, "kg m^2");
  findings.positive("platform_hull_radius", robot.platform_hull_radius, "m");
  findings.positive("link_radius", robot.link_radius, "m");
  findings.positive("friction_velocity", robot.friction_velocity, "rad/s");
  find_gravity_problems(robot.gravity, findings);
}

double distance_at_home(const PlanarRrrParameters& robot, const PlanarRrrLeg& leg) {
  const double coupling = robot.home_pose.z() + leg.coupling_angle;
  const Eigen::Vector2d base(leg.base_radius * std::sin(leg.base_angle),
                             -leg.base_radius * std::cos(leg.base_angle));
  const Eigen::Vector2d arm(robot.coupling_radius * std::cos(coupling),
                            robot.coupling_radius * std::sin(coupling));
  return (robot.home_pose.head<2>() + arm - base).norm();
}

}  // namespace

std::vector<std::string> problems(const PlanarRrrParameters& parameters) {
  Findings findings;
  if (parameters.name.empty()) findings.add("name is empty; a robot needs a name");
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    check_leg("legs[" + std::to_string(i) + "].", parameters.legs[i], findings);
  }
  check_platform(parameters, findings);
  findings.finite("home_pose", parameters.home_pose, "m or rad");
  if (!findings.none()) return findings.take();
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    const PlanarRrrLeg& leg = parameters.legs[i];
    find_reach_problem(i, leg, distance_at_home(parameters, leg), findings);
  }
  return findings.take();
}

}  // namespace flinch
