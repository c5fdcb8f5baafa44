#pragma once

#include <algorithm>

#include "drivers/clock_map.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {

/// Tells monotonic times in the time of a loop's ticks and back. A tick starts when it is due or, the machine
/// being busy, later; the most punctual starts are right, as ClockMap says. A start that is late by whole
/// periods means that these were lost (RealtimeRunner): the ticks lie behind the clock by as much. This clock
/// follows in small steps, a hundredth of a period each tick, so that the spacing of stamps, by which others
/// differentiate, does not jump; until it has caught up, stamps look older than they are. More than two
/// periods behind it catches up at once, which others must take for the interruption that it is. Loops whose
/// time follows the clock (RealtimeRunner::follow_clock) are never behind.
class TickClock {
 public:
  /// `period`: from tick to tick.
  explicit TickClock(Time period) : period_(period) {}

  /// To be called when a tick starts.
  void start_tick(Time tick) noexcept { start_tick(tick, MonotonicClock::now()); }
  /// The same at a given monotonic time.
  void start_tick(Time tick, Time now) noexcept {
    if (tick < tick_) *this = TickClock(period_);  // a new run
    const Time late = map_.started() ? now - map_.to_here(tick) - behind_ : Time::zero();
    if (late >= period_) behind_ += late / period_ * period_;
    const Time step = behind_ > 2 * period_ ? behind_ : std::min(behind_, period_ / 100);
    behind_ -= step;
    map_.shift(step);
    map_.observe(tick, now - behind_);
    tick_ = tick;
  }

  /// To be called instead where a tick waits for its readings, in lockstep: times are those of ticks at both
  /// ends, and nothing is translated.
  void stand_at(Time tick) noexcept {
    map_ = ClockMap();
    behind_ = Time::zero();
    tick_ = tick;
  }

  /// A monotonic time in that of the ticks; at latest that of this tick: a loop that is late does not see
  /// the future.
  Time to_tick_time(Time monotonic) const noexcept { return std::min(map_.to_there(monotonic), tick_); }
  Time to_monotonic(Time tick) const noexcept { return map_.to_here(tick); }

 private:
  Time period_;
  Time tick_{};
  Time behind_{};  ///< what was lost and is not yet caught up
  ClockMap map_;
};

}  // namespace flinch
