#pragma once

#include <Eigen/Core>

namespace flinch {

/// What an IMU tells beside the truth, constant or slow, as it is estimated; in its own frame S.
struct ImuBias {
  bool valid = false;
  Eigen::Vector3d gyroscope{0.0, 0.0, 0.0};      ///< [rad/s]
  Eigen::Vector3d accelerometer{0.0, 0.0, 0.0};  ///< [m/s^2]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("gyroscope", "rad/s", self.gyroscope, "imu");
    visit("accelerometer", "m/s^2", self.accelerometer, "imu");
  }
};

}  // namespace flinch
