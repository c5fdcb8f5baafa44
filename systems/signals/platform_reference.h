#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// Where the platform shall be now.
struct PlatformReference {
  bool valid = false;
  bool finished = false;        ///< the motion has arrived and is at rest
  Configuration pose;           ///< x_d, in the base frame
  PlatformVector velocity;      ///< v_d
  PlatformVector acceleration;  ///< dv_d/dt

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
