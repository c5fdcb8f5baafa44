#pragma once

#include <Eigen/Core>

#include "systems/framework/time.h"

namespace flinch {

/// One sample of an inertial measurement unit on the platform, in its own frame S.
struct ImuReading {
  Time acquired{};  ///< when it was measured, to 0.1 ms, on any tick or between; not when it arrived
  bool valid = false;
  Eigen::Vector3d angular_velocity{0.0, 0.0, 0.0};  ///< [rad/s]
  Eigen::Vector3d specific_force{0.0, 0.0, 0.0};    ///< acceleration minus gravity [m/s^2]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("angular_velocity", "rad/s", self.angular_velocity, "imu");
    visit("specific_force", "m/s^2", self.specific_force, "imu");
  }
};

}  // namespace flinch
