#pragma once

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Drive torques computed from motor currents, one entry per drive.
struct DriveTorque {
  Time acquired{};
  bool valid = false;
  JointVector torque;   ///< tau_a = k_t i, delay and cogging where known [Nm or N]
  bool braked = false;  ///< closed brakes add to it what nobody measures

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("torque", "<drive force>", self.torque);
    visit("braked", "", self.braked);
  }
};

}  // namespace flinch
