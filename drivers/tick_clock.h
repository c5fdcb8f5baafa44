#pragma once

#include <algorithm>

#include "drivers/clock_map.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {

/// Tells monotonic times in the time of a loop's ticks and back. A tick starts when it is due or, the machine
/// being busy, later; the most punctual starts are right, as ClockMap says. A start that is late by whole
/// periods means that these were lost (RealtimeRunner): from then on the ticks lie behind the clock by as
/// much.
class TickClock {
 public:
  /// `period`: from tick to tick.
  explicit TickClock(Time period) : period_(period) {}

  /// To be called when a tick starts.
  void start_tick(Time tick) noexcept { start_tick(tick, MonotonicClock::now()); }
  /// The same at a given monotonic time.
  void start_tick(Time tick, Time now) noexcept {
    if (tick < tick_) map_ = ClockMap();  // a new run
    const Time late = map_.started() ? now - map_.to_here(tick) : Time::zero();
    if (late >= period_) map_.shift(late / period_ * period_);
    map_.observe(tick, now);
    tick_ = tick;
  }

  /// A monotonic time in that of the ticks; at latest that of this tick: a loop that is late does not see
  /// the future.
  Time to_tick_time(Time monotonic) const noexcept { return std::min(map_.to_there(monotonic), tick_); }
  Time to_monotonic(Time tick) const noexcept { return map_.to_here(tick); }

 private:
  Time period_;
  Time tick_{};
  ClockMap map_;
};

}  // namespace flinch
