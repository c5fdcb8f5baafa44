#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Motor currents, one entry per drive, as means since the tick before: they tell the torque that acted then.
struct DriveReading {
  Time acquired{};  ///< end of that time; where a drive holds its torque, any instant of it tells the mean
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
