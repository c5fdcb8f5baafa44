#pragma once

#include <cstdint>

#include "drivers/drive_state.h"
#include "systems/framework/system.h"

namespace flinch {

/// What a master asks of a drive. CiA 402, object 6040h.
struct Controlword {
  std::uint16_t bits = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("bits", "", self.bits);
  }
};

/// What a drive says of its state. CiA 402, object 6041h.
struct Statusword {
  std::uint16_t bits = 0;

  DriveState state() const { return state_in(bits); }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("bits", "", self.bits);
  }
};

/// What makes a drive change its state by itself.
struct DriveCondition {
  bool started = false;     ///< it has tested and set itself up
  bool fault = true;        ///< something is wrong with it
  bool standstill = false;  ///< it does not turn: a quick stop or fault reaction has ended

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("started", "", self.started);
    visit("fault", "", self.fault);
    visit("standstill", "", self.standstill);
  }
};

/// The state machine of a drive, at each tick at most one transition: 13 (a fault) before all others, then
/// those that the drive makes by itself, then what the controlword asks for. A fault that is still there is
/// not reset.
class DriveStateMachine final : public System {
 public:
  struct Memory {
    DriveState state = DriveState::not_ready_to_switch_on;
    Controlword last;
  };

 private:
  State<Memory> memory_ = state<Memory>("memory");

 public:
  InputPort<Controlword> controlword = input<Controlword>("controlword");
  InputPort<DriveCondition> condition = input<DriveCondition>("condition");
  OutputPort<Statusword> statusword = output<&DriveStateMachine::tell>("statusword", memory_);

  /// The state after one tick.
  static Memory next(const Memory& memory, const Controlword& word, const DriveCondition& drive) noexcept;

 private:
  Update advance_ = update<&DriveStateMachine::advance>(memory_, memory_, controlword, condition);

  Statusword tell(const Memory& memory) const { return {statusword_of(memory.state)}; }
  Memory advance(const Memory& memory, const Controlword& word, const DriveCondition& drive) const {
    return next(memory, word, drive);
  }
};

}  // namespace flinch
