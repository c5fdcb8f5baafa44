#pragma once

#include "systems/framework/time.h"
#include "systems/robot/leg_bases.h"

namespace flinch {

/// One sample of force sensors below the base joints.
struct BaseForceReading {
  Time acquired{};
  bool valid = false;
  BaseForces force_in_base;  ///< on each leg [N]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("force_in_base", "N", self.force_in_base, "base");
  }
};

}  // namespace flinch
