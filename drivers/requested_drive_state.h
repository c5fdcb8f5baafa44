#pragma once

#include <cstdint>

namespace flinch {

/// What the drives shall be, by an operator or a supervisor. CiA 402.
struct RequestedDriveState {
  enum class State : std::uint8_t { without_voltage, switched_on, operation_enabled, quick_stop };
  State state = State::without_voltage;
  bool engage_brake = true;        ///< the brakes shall close whatever the torque commands say
  std::uint32_t fault_resets = 0;  ///< a larger number than before asks to reset a fault

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("state", "", self.state);
    visit("engage_brake", "", self.engage_brake);
    visit("fault_resets", "", self.fault_resets);
  }
};

}  // namespace flinch
