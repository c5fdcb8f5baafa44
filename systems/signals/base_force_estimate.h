#pragma once

#include "systems/framework/time.h"
#include "systems/robot/leg_bases.h"

namespace flinch {

/// What of the forces at the base joints comes from contacts with the legs, see `LegBases`.
struct BaseForceEstimate {
  Time acquired{};           ///< of the readings that it tells of
  bool valid = false;        ///< also false while the observer settles
  BaseForces force_in_base;  ///< of each leg [N]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("force_in_base", "N", self.force_in_base, "base");
  }
};

}  // namespace flinch
