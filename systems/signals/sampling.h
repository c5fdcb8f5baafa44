#pragma once

#include <algorithm>

#include "systems/framework/time.h"

namespace flinch {

/// The whole number of periods nearest to `time`, at least `least`.
constexpr int periods_in(Time time, Time period, int least = 1) {
  return std::max(least, static_cast<int>((time + period / 2) / period));
}

/// The shortest multiple of `period` that is no shorter than `time`.
constexpr Time whole_periods(Time time, Time period) { return (time + period - Time(1)) / period * period; }

/// Of a reading or a command by which a robot may still be moved: at every rate one may be missing.
constexpr Time longest_age(Time period) { return std::max<Time>(3ms, 2 * period); }

/// When samples are due, and how long a block may live on its last good one while they fail to appear.
struct Sampling {
  Time period = 1ms;
  Time longest_hold = 2ms;

  /// Of a control path: at every rate one sample may be missing.
  static constexpr Sampling each(Time period) {
    return {.period = period, .longest_hold = std::max<Time>(2ms, period)};
  }

  friend bool operator==(const Sampling&, const Sampling&) = default;

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
