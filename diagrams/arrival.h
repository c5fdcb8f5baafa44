#pragma once

#include <cstdint>

namespace flinch {

/// The last reading that has arrived from outside when a tick begins; the same again where nothing new came.
template <class Reading>
struct Arrival {
  Reading reading;  ///< `acquired` in the time of the ticks
  /// Who sent it, a number of its own for each start of a sender; 0: nothing has come.
  std::uint32_t source = 0;
  std::uint32_t number = 0;  ///< counts the readings of that source; wraps around

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("reading", "", self.reading);
    visit("source", "", self.source);
    visit("number", "", self.number);
  }
};

}  // namespace flinch
