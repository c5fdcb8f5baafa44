#include "plant/compliant_obstacle.h"

#include "plant/setting_problems.h"

namespace flinch {

std::vector<std::string> problems(const CompliantMount& mount, const std::string& owner) {
  SettingProblems problems(owner);
  problems.require_positive("mass", mount.mass);
  problems.require_positive("mount_stiffness", mount.stiffness);
  problems.require_not_negative("mount_damping", mount.damping);
  return problems.found();
}

void CompliantObstacle::find_problems(const std::string& owner, std::vector<std::string>& found) const {
  for (std::string& problem : flinch::problems(mount_, owner)) found.push_back(std::move(problem));
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
