#pragma once

#include <cstdint>

#include "systems/framework/time.h"

namespace flinch {

/// What the robot is doing about contacts. [SafePR] Alg. 5, and what a real station needs besides.
enum class ReactionMode : std::uint8_t {
  stopped,  ///< the torque gate lets no torque of the laws through: before it opened, or after a fault
  nominal,  ///< follows its nominal motion
  react,    ///< gives way to a contact
  hold,     ///< has given way and keeps its place until the operator resets
  zero_g,   ///< gravity is compensated and nothing else, until the operator resets
  recover,  ///< comes back slowly, by the operator's targets, from where it must not stand
};

/// The mode now, and the transition that led to it.
struct ReactionState {
  ReactionMode mode = ReactionMode::stopped;
  ReactionMode previous = ReactionMode::stopped;  ///< the mode before
  Time since{};                                   ///< tick of the transition from `previous` to `mode`

  /// Whether `mode` was entered at the tick `now`.
  bool entered(ReactionMode wanted, Time now) const {
    return mode == wanted && previous != wanted && since == now;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("mode", "", self.mode);
    visit("previous", "", self.previous);
    visit("since", "ns", self.since);
  }
};

}  // namespace flinch
