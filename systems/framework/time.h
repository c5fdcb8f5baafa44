#pragma once

#include <chrono>

namespace flinch {

/// Points in time and durations: an integer count of nanoseconds since the start of the run.
using Time = std::chrono::nanoseconds;

using namespace std::chrono_literals;

/// `time` in seconds.
constexpr double to_seconds(Time time) { return 1e-9 * static_cast<double>(time.count()); }

/// `seconds` rounded to the nearest nanosecond.
constexpr Time from_seconds(double seconds) {
  return Time(static_cast<Time::rep>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5)));
}

/// When something periodic is due: at the instants offset, offset + period, offset + 2 period, ... or, where
/// the time has skipped one, at the first tick after it.
struct Every {
  Time period{};
  Time offset{};

  /// Whether an instant is `now`, or has been skipped since the tick before, which was `elapsed` ago.
  constexpr bool due(Time now, Time elapsed = Time::zero()) const {
    if (now < offset) return false;
    if (elapsed >= period) return true;
    const Time since_instant = (now - offset) % period;
    return since_instant == Time::zero() || since_instant < elapsed;
  }
  friend constexpr bool operator==(const Every&, const Every&) = default;
};

}  // namespace flinch
