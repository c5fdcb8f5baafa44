#pragma once

#include <algorithm>

#include "systems/framework/time.h"

namespace flinch {

/// Drives are commanded at ticks and hold what they reach. Some reach it at once, some evenly in this time;
/// which of them they are, nobody says. In the middle they are as late in the mean as a current loop with a
/// bandwidth of 1 kHz; slower loops are left to the lag that is calibrated. (Derived.)
inline constexpr Time drive_rise = 600us;

/// How far, `since_tick` after a tick, the drives have gone from the torque of that tick to that of the
/// next, 0 to 1: the middle between all at once and evenly.
constexpr double driven_share(Time since_tick) {
  return 0.5 + 0.5 * std::min(1.0, to_seconds(since_tick) / to_seconds(drive_rise));
}

/// By how much they may have gone further, or less far.
constexpr double driven_uncertainty(Time since_tick) { return 1.0 - driven_share(since_tick); }

/// What `driven_share` adds up to since the tick [s].
constexpr double driven_time(Time since_tick) {
  const double time = to_seconds(since_tick), rise = to_seconds(drive_rise);
  return time < rise ? 0.5 * time + 0.25 * time * time / rise : time - 0.25 * rise;
}

}  // namespace flinch
