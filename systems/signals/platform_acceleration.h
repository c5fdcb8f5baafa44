#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Acceleration of the platform, measured or estimated.
struct PlatformAcceleration {
  Time acquired{};
  bool valid = false;
  PlatformVector acceleration;  ///< dv/dt, in the base frame

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("acceleration", "<acceleration>", self.acceleration, "base");
  }
};

}  // namespace flinch
