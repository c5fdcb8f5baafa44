#include "plant/hand.h"

#include "plant/setting_problems.h"

namespace flinch {

void Hand::find_problems(const std::string& owner, std::vector<std::string>& found) const {
  for (std::string& problem : flinch::problems(arm_, owner)) found.push_back(std::move(problem));
  for (std::string& problem : led_.problems(owner)) found.push_back(std::move(problem));
  if (!grip_) return;
  SettingProblems problems(owner + "hold.");
  problems.require_positive("stiffness", grip_->stiffness);
  problems.require_not_negative("damping", grip_->damping);
  problems.append_to(found);
  if (!(grip_->times.end > grip_->times.begin)) found.push_back(owner + "hold ends before it begins");
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
