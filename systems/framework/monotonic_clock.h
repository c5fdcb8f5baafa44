#pragma once

#include <ctime>

#include "systems/framework/time.h"

namespace flinch {

/// The machine's clock that never jumps (CLOCK_MONOTONIC): the time since some start, the same for all
/// programs.
struct MonotonicClock {
  static Time now() noexcept;

  /// Blocks the calling thread until now() has reached `time`; signals do not end it early.
  static void sleep_until(Time time) noexcept;

  /// `time` as the C library wants it. Not for negative times.
  static std::timespec to_timespec(Time time) noexcept;
};

}  // namespace flinch
