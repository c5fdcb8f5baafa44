#pragma once

#include <cstdint>

#include "systems/framework/time.h"

namespace flinch {

/// What a tick has found where a reading comes in.
enum class Flow : std::uint8_t {
  nothing,       ///< no reading has come since the start
  fresh,         ///< a new one
  repeated,      ///< none since the last tick; the last one is still young enough
  stale,         ///< none for too long, or a new one that is already too old
  out_of_order,  ///< an older one than has been seen: not used
  broken,        ///< a new one with a value that is not finite, of another size, or acquired after now or
                 ///< before the last one
  restarted,     ///< the first one of another source: not used
};

/// How a reading comes in from outside.
struct LinkStatus {
  Flow flow = Flow::nothing;
  Time age{};                 ///< of the reading by its acquisition; 0 while there is none
  std::uint32_t skipped = 0;  ///< numbers that no tick has seen, since the start
  /// Ticks that found one out of order, broken or of another source, since the start.
  std::uint32_t refused = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("flow", "", self.flow);
    visit("age", "ns", self.age);
    visit("skipped", "", self.skipped);
    visit("refused", "", self.refused);
  }
};

}  // namespace flinch
