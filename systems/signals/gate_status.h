#pragma once

#include <cstdint>

#include "systems/framework/time.h"
#include "systems/signals/gate_fault.h"

namespace flinch {

enum class GatePhase : std::uint8_t {
  waiting,  ///< since the start of the run, until no fault is present: no torque, brakes closed
  open,     ///< the laws' torques reach the station
  closed,   ///< after a fault, until the operator resets: `reaction` instead
  /// The operator has reset, but the robot stands where it must not: the laws' torques reach the station,
  /// reduced, until it has come back inside.
  recovering,
};

/// What the torque gate does and why.
struct GateStatus {
  GatePhase phase = GatePhase::waiting;
  GateReaction reaction = GateReaction::zero_torque_and_brake;  ///< none while open or recovering
  GateFault fault = GateFault::none;  ///< the first one; kept until the next, also after a reset
  FaultMask faults = 0;    ///< waiting, recovering: present now; closed: all since it closed; open: none
  Time since{};            ///< tick at which the phase began
  bool saturated = false;  ///< a torque or its rate is being limited

  /// Whether the torques of the laws reach the station.
  bool passes() const { return phase == GatePhase::open || phase == GatePhase::recovering; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("phase", "", self.phase);
    visit("reaction", "", self.reaction);
    visit("fault", "", self.fault);
    visit("faults", "", self.faults);
    visit("since", "ns", self.since);
    visit("saturated", "", self.saturated);
  }
};

}  // namespace flinch
