#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/robot/hexapod.h"
#include "tests/peer/mujoco_model.h"

namespace flinch::peer {

/// The hexapod in MuJoCo: six serial legs of two hinges and a slide, a free platform, and six `connect`
/// constraints that close the legs on it.
class MujocoHexapod {
 public:
  /// Friction is viscous only.
  explicit MujocoHexapod(const Hexapod& robot);

  /// Platform acceleration [m/s^2, rad/s^2] at the state of `kinematics` under drive forces.
  Eigen::Matrix<double, 6, 1> platform_acceleration(const Kinematics& kinematics,
                                                    const Eigen::Matrix<double, 6, 1>& drive_forces);

 private:
  void set_leg(int leg, const Kinematics& kinematics);

  const Hexapod& robot_;
  std::array<Eigen::Matrix3d, 6> axes_at_zero_;  ///< Of the legs, in the base frame, all hinges at zero.
  MujocoModel mujoco_;
};

}  // namespace flinch::peer
