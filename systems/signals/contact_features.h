#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// What of a contact tells the bodies of a robot apart in any of its poses. [SafePR] Alg. 1
struct ContactFeatures {
  Time acquired{};     ///< of the readings that they tell of
  bool valid = false;  ///< There is a force to speak of; otherwise all below is zero.
  /// The platform can be turned, so its moment tells where the line of action lies; otherwise all distances
  /// are zero.
  bool has_lever = false;
  PlatformVector wrench_in_base;  ///< F_ext [N, Nm]
  JointVector drive_torque;       ///< tau_a,ext
  JointVector distance;     ///< d: of each leg's coupling joint from the line of action, [SafePR] (17) [m]
  JointVector angle;        ///< alpha: between force and each leg's last link, 0 to pi, [SafePR] (18) [rad]
  int affected_drives = 0;  ///< n_tau: drives that feel the contact

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("has_lever", "", self.has_lever);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
    visit("drive_torque", "<drive force>", self.drive_torque);
    visit("distance", "m", self.distance);
    visit("angle", "rad", self.angle);
    visit("affected_drives", "", self.affected_drives);
  }
};

}  // namespace flinch
