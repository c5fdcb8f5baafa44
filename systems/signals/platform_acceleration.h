#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"
#include "systems/signals/estimator_health.h"

namespace flinch {

/// Acceleration of the platform, measured or estimated.
struct PlatformAcceleration {
  Time acquired{};  ///< when the platform moved like this; may lie some milliseconds back
  bool valid = false;
  PlatformVector acceleration;          ///< dv/dt, in the base frame
  PlatformVector standard_deviation{};  ///< of each component, from the noise of the sensors; empty: unknown
  EstimatorHealth health{};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("acceleration", "<acceleration>", self.acceleration, "base");
    visit("standard_deviation", "<acceleration>", self.standard_deviation, "base");
    visit("health", "", self.health);
  }
};

}  // namespace flinch
