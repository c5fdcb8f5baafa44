#pragma once

#include <algorithm>

#include "systems/framework/time.h"

namespace flinch {

/// How far, `since_tick` after a tick, the drives have gone from the torque of that tick to that of the
/// next, 0 to 1. They are commanded at ticks and hold what they reach. Here they reach it evenly in 0.3 ms,
/// which is as late in the mean as a current loop with a bandwidth of 1 kHz. (Derived.)
constexpr double driven_share(Time since_tick) {
  constexpr Time rise = 300us;
  return std::min(1.0, to_seconds(since_tick) / to_seconds(rise));
}

}  // namespace flinch
