#pragma once

#include <array>

#include "systems/framework/time.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// What the drives do from one tick to the next. The default: no torque, brakes closed.
struct DriveAction {
  JointVector torque;    ///< Acting on the drives, without the brakes'; empty: none.
  JointVector current;   ///< In the motors [A].
  bool enabled = false;  ///< A command is obeyed.
  bool braked = true;    ///< The brakes have been told to close.
  Time since = -24h;     ///< When they were; or told to open.
  /// Share of its friction that the brake of each drive puts on it; empty: all where braked, else nothing.
  JointVector hold{};

  /// Of the motors in a tick, without the delay of their torques.
  struct TickCurrent {
    JointVector mean;     ///< [A]
    JointVector current;  ///< at its end [A]
  };
  std::array<TickCurrent, most_delayed + 1> currents{};  ///< of late, the latest first; empty: none

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("torque", "<drive force>", self.torque);
    visit("current", "A", self.current);
    visit("enabled", "", self.enabled);
    visit("braked", "", self.braked);
    visit("since", "ns", self.since);
    visit("hold", "", self.hold);
  }
};

}  // namespace flinch
