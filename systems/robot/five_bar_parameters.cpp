#include "systems/robot/five_bar_parameters.h"

#include <cstddef>

namespace flinch {

std::vector<std::string> problems(const FiveBarParameters& parameters) {
  Findings findings;
  if (parameters.name.empty()) findings.add("name is empty; a robot needs a name");
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    const std::string path = "legs[" + std::to_string(i) + "].";
    find_problems(path, parameters.legs[i], findings);
    findings.finite(path + "base_joint", parameters.legs[i].base_joint, "m");
  }
  findings.positive("platform_mass", parameters.platform_mass, "kg");
  findings.positive("platform_radius", parameters.platform_radius, "m");
  findings.positive("link_radius", parameters.link_radius, "m");
  findings.positive("friction_velocity", parameters.friction_velocity, "rad/s");
  find_gravity_problems(parameters.gravity, findings);
  findings.finite("home_pose", parameters.home_pose, "m");
  if (!findings.none()) return findings.take();
  for (std::size_t i = 0; i < parameters.legs.size(); ++i) {
    const FiveBarLeg& leg = parameters.legs[i];
    find_reach_problem(i, leg, (parameters.home_pose - leg.base_joint).norm(), findings);
  }
  return findings.take();
}

}  // namespace flinch
