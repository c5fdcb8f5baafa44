#pragma once

#include "systems/robot/vectors.h"

namespace flinch {

/// What the drives do from one tick to the next. The default: no torque, brakes closed.
struct DriveAction {
  JointVector torque;    ///< Acting on the drives, without the brakes'; empty: none.
  JointVector current;   ///< In the motors [A].
  bool enabled = false;  ///< A command is obeyed.
  bool braked = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("torque", "<drive force>", self.torque);
    visit("current", "A", self.current);
    visit("enabled", "", self.enabled);
    visit("braked", "", self.braked);
  }
};

}  // namespace flinch
