#pragma once

#include "systems/framework/time.h"

namespace flinch {

/// When samples are due, and how long a block may live on its last good one while they fail to appear.
struct Sampling {
  Time period = 1ms;
  Time longest_hold = 2ms;

  /// At tick `now`: whether the last good sample, which arrived at tick `arrived`, is too old to be held.
  constexpr bool expired(Time arrived, Time now) const { return now - arrived > longest_hold; }

  /// Whether samples acquired at these times are too far apart to be differentiated or integrated across.
  constexpr bool interrupted(Time previous, Time acquired) const {
    return acquired - previous > longest_hold + period;
  }

  /// Whether a sample is missing between those acquired at these times.
  constexpr bool lost_between(Time previous, Time acquired) const {
    return acquired - previous > period + period / 2;
  }
};

}  // namespace flinch
