#pragma once

#include <algorithm>

#include "systems/framework/time.h"

namespace flinch {

/// Drives are commanded at ticks and hold what they reach. Here they reach it evenly in this time, which is
/// as late in the mean as a current loop with a bandwidth of 1 kHz. (Derived.)
inline constexpr Time drive_rise = 300us;

/// How far, `since_tick` after a tick, the drives have gone from the torque of that tick to that of the
/// next, 0 to 1.
constexpr double driven_share(Time since_tick) {
  return std::min(1.0, to_seconds(since_tick) / to_seconds(drive_rise));
}

/// What that adds up to since the tick [s].
constexpr double driven_time(Time since_tick) {
  const double time = to_seconds(since_tick), rise = to_seconds(drive_rise);
  return time < rise ? 0.5 * time * time / rise : time - 0.5 * rise;
}

}  // namespace flinch
