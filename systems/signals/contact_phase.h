#pragma once

#include "systems/framework/time.h"

namespace flinch {

/// Whether a contact lasts that is to be told about: one from its detection until it has been gone for a
/// while.
struct ContactPhase {
  bool active = false;
  Time since{};  ///< tick at which the present or latest one was detected

  bool begins(Time now) const { return active && since == now; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("active", "", self.active);
    visit("since", "ns", self.since);
  }
};

}  // namespace flinch
