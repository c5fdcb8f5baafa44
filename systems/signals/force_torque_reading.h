#pragma once

#include <Eigen/Core>

#include "systems/framework/time.h"

namespace flinch {

/// One sample of a force-torque instrument: what an object does to the robot that stands on it, or a rope
/// that is tied to it where it is mounted on the robot. For validation and calibration; no control block
/// reads it.
struct ForceTorqueReading {
  Time acquired{};
  bool valid = false;
  Eigen::Vector3d force_in_base{0.0, 0.0, 0.0};   ///< [N]
  Eigen::Vector3d moment_in_base{0.0, 0.0, 0.0};  ///< about the sensor's origin [Nm]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("force_in_base", "N", self.force_in_base, "base");
    visit("moment_in_base", "Nm", self.moment_in_base, "base");
  }
};

}  // namespace flinch
