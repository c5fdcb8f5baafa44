#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// Where the platform shall be now.
struct PlatformReference {
  bool valid = false;
  bool finished = false;        ///< the motion has arrived and is at rest
  PlatformVector pose;          ///< x_d, in the base frame [m, m, rad]
  PlatformVector velocity;      ///< [m/s, m/s, rad/s]
  PlatformVector acceleration;  ///< [m/s^2, m/s^2, rad/s^2]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("finished", "", self.finished);
    visit("pose", "<pose>", self.pose, "base");
    visit("velocity", "<velocity>", self.velocity, "base");
    visit("acceleration", "<acceleration>", self.acceleration, "base");
  }
};

}  // namespace flinch
