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

/// When a periodic update is due: at offset, offset + period, offset + 2 period, ...
struct Every {
  Time period{};
  Time offset{};

  constexpr bool due(Time now) const { return now >= offset && (now - offset) % period == Time::zero(); }
  friend constexpr bool operator==(const Every&, const Every&) = default;
};

}  // namespace flinch
