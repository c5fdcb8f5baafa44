#include "plant/compliant_obstacle.h"

#include "systems/foundation/findings.h"

namespace flinch {

std::vector<std::string> problems(const CompliantMount& mount, const std::string& owner) {
  Findings found(owner);
  found.positive("mass", mount.mass, "kg");
  found.positive("mount_stiffness", mount.stiffness, "N/m");
  found.not_negative("mount_damping", mount.damping, "N s/m");
  return found.take();
}

void CompliantObstacle::find_problems(const std::string& owner, Findings& found) const {
  found.add_all(flinch::problems(mount_, owner));
}

Eigen::Vector3d CompliantObstacle::acceleration(double t, const ObstacleMotion& now,
                                                const Eigen::Vector3d& contact_force) const noexcept {
  return (contact_force - force_on_mount(t, now, contact_force)) / mount_.mass;
}

Eigen::Vector3d CompliantObstacle::force_on_mount(double, const ObstacleMotion& now,
                                                  const Eigen::Vector3d&) const noexcept {
  return mount_.stiffness * now.displacement + mount_.damping * now.velocity;
}

}  // namespace flinch
