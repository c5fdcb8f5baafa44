#pragma once

#include <Eigen/Core>
#include <optional>

#include "systems/robot/legs/legs_robot.h"
#include "tests/peer/mujoco_model.h"

namespace flinch::peer {

/// A robot of kind `legs` in MuJoCo, as `mjcf_text` writes it. Where its joints stand MuJoCo finds itself, by
/// closing its own constraints from home on.
class MujocoLegs {
 public:
  /// Of a robot without dry friction, for which MuJoCo has another law.
  explicit MujocoLegs(const LegsParameters& parameters);

  /// Of the platform [m/s^2, rad/s^2] under efforts of the drives; none where the loops do not close there.
  std::optional<PlatformVector> platform_acceleration(const Configuration& pose,
                                                      const PlatformVector& velocity,
                                                      const JointVector& efforts);

 private:
  /// Places the platform, and closes the loops by Newton's method from where the joints are.
  bool close(const Configuration& pose);
  void set_platform(const Configuration& pose);
  void set_rates(const Configuration& pose, const PlatformVector& velocity);
  Eigen::MatrixXd constraint_jacobian();
  /// Coordinates of the platform as its own axes have angular velocities, which is how MuJoCo counts them.
  Eigen::MatrixXd to_own_axes(const Configuration& pose) const;

  LegsRobot robot_;
  MujocoModel mujoco_;
};

}  // namespace flinch::peer
