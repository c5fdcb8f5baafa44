#pragma once

#include <cstdint>

#include "systems/framework/time.h"

namespace flinch {

/// What the drives and whatever stands behind them say of themselves.
struct StationStatus {
  Time acquired{};
  bool valid = false;
  bool enabled = false;  ///< the drives are powered and act upon valid torque commands
  bool braked = false;   ///< the brakes are closed
  bool fault = false;    ///< a drive reports a fault

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("enabled", "", self.enabled);
    visit("braked", "", self.braked);
    visit("fault", "", self.fault);
  }
};

}  // namespace flinch
