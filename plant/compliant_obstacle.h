#pragma once

#include "plant/obstacle.h"

namespace flinch {

/// A mass on a spring and a damper, alike in all directions.
struct CompliantMount {
  double mass = 1.0;          ///< [kg]
  double stiffness = 2000.0;  ///< [N/m]
  double damping = 20.0;      ///< [N s/m]
};

/// All that is wrong with `mount`, one sentence each that begins with `owner`.
std::vector<std::string> problems(const CompliantMount& mount, const std::string& owner);

/// An obstacle that moves as a mass on a spring and a damper: m a = f - k x - d v.
class CompliantObstacle final : public Obstacle {
 public:
  CompliantObstacle(ObstacleForm form, const CompliantMount& mount)
      : Obstacle(std::move(form)), mount_(mount) {}

  const CompliantMount& mount() const noexcept { return mount_; }

  bool moves_freely() const noexcept override { return true; }
  Eigen::Vector3d acceleration(double t, const ObstacleMotion& now,
                               const Eigen::Vector3d& contact_force) const noexcept override;
  Eigen::Vector3d force_on_mount(double t, const ObstacleMotion& now,
                                 const Eigen::Vector3d& contact_force) const noexcept override;

 protected:
  void find_problems(const std::string& owner, Findings& found) const override;

 private:
  CompliantMount mount_;
};

}  // namespace flinch
