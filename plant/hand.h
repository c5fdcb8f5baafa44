#pragma once

#include <optional>

#include "plant/compliant_obstacle.h"
#include "plant/obstacle_path.h"

namespace flinch {

/// How a hand holds on: a spring and a damper between it and the point of the robot that it holds.
struct Grip {
  HoldingTimes times;         ///< It holds what it touches at `begin`, or touches first after that.
  double stiffness = 3000.0;  ///< [N/m]
  double damping = 60.0;      ///< [N s/m]
};

/// A hand, or an arm: a mass on a spring and a damper whose other end is led along a path. So it strikes,
/// presses or is drawn back; between two times it also holds the body that it touches, and lets go.
///   m a = f - k (x - x_led) - d (v - v_led)
class Hand final : public Obstacle {
 public:
  Hand(ObstacleForm form, const CompliantMount& arm, ObstaclePath led, const std::optional<Grip>& grip = {})
      : Obstacle(std::move(form)), arm_(arm), led_(std::move(led)), grip_(grip) {}

  bool moves_freely() const noexcept override { return true; }
  bool follows_time() const noexcept override { return true; }
  ObstacleMotion motion(double t) const noexcept override { return led_.at(t); }
  Eigen::Vector3d acceleration(double t, const ObstacleMotion& now,
                               const Eigen::Vector3d& contact_force) const noexcept override;
  Eigen::Vector3d force_on_mount(double t, const ObstacleMotion& now,
                                 const Eigen::Vector3d& contact_force) const noexcept override;
  const HoldingTimes* holding() const noexcept override { return grip_ ? &grip_->times : nullptr; }
  Eigen::Vector3d grip_force(const Eigen::Vector3d& stretch,
                             const Eigen::Vector3d& rate) const noexcept override;

 protected:
  void find_problems(const std::string& owner, Findings& found) const override;

 private:
  CompliantMount arm_;
  ObstaclePath led_;
  std::optional<Grip> grip_;
};

}  // namespace flinch
