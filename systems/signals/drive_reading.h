#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Motor currents at one instant, one entry per drive.
struct DriveReading {
  Time acquired{};
  bool valid = false;
  JointVector current;  ///< torque-producing current i_q [A]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("current", "A", self.current);
  }
};

}  // namespace flinch
