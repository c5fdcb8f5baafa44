#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Torques for the drives, one entry per drive. Only the torque gate's reach a station.
struct TorqueCommand {
  Time computed{};     ///< tick at which it was computed
  bool valid = false;  ///< false: apply no torque
  JointVector torque;  ///< tau_a,d [Nm]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("computed", "ns", self.computed);
    visit("valid", "", self.valid);
    visit("torque", "<drive force>", self.torque);
  }
};

}  // namespace flinch
