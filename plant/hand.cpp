#include "plant/hand.h"

#include "systems/foundation/findings.h"

namespace flinch {

void Hand::find_problems(const std::string& owner, Findings& found) const {
  found.add_all(flinch::problems(arm_, owner));
  found.add_all(led_.problems(owner));
  if (!grip_) return;
  found.positive("grip.stiffness", grip_->stiffness, "N/m");
  found.not_negative("grip.damping", grip_->damping, "N s/m");
  found.require(grip_->times.end > grip_->times.begin, "grip ends before it begins");
}

Eigen::Vector3d Hand::acceleration(double t, const ObstacleMotion& now,
                                   const Eigen::Vector3d& contact_force) const noexcept {
  return (contact_force - force_on_mount(t, now, contact_force)) / arm_.mass;
}

Eigen::Vector3d Hand::force_on_mount(double t, const ObstacleMotion& now,
                                     const Eigen::Vector3d&) const noexcept {
  const ObstacleMotion led = led_.at(t);
  return arm_.stiffness * (now.displacement - led.displacement) +
         arm_.damping * (now.velocity - led.velocity);
}

Eigen::Vector3d Hand::grip_force(const Eigen::Vector3d& stretch, const Eigen::Vector3d& rate) const noexcept {
  return -grip_->stiffness * stretch - grip_->damping * rate;
}

}  // namespace flinch
