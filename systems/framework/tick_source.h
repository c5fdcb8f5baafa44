#pragma once

#include <algorithm>
#include <optional>

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/time.h"

namespace flinch {

/// What the ticks of a real-time run wait for, and the clock that they are timed with.
class TickSource {
 public:
  virtual ~TickSource() = default;

  /// The time of a clock that never jumps [ns].
  virtual Time now() { return MonotonicClock::now(); }

  /// When the first tick of a run that begins `now` is due.
  virtual Time first_due(Time now, Time /*period*/) { return now; }

  /// Blocks until the tick that is due at `due`, which may have passed, shall start.
  virtual void wait(Time due) = 0;

  /// Whether there will be no more ticks: the one that was waited for last does not run, nor any after it.
  virtual bool is_over() const { return false; }
};

/// Ticks by the clock: each starts when it is due. Runs that follow each other keep their step.
class ClockTicks final : public TickSource {
 public:
  /// Lets the first tick of the next run be due at `time`, or whole periods later.
  void begin_at(Time time) { step_ = time; }

  Time first_due(Time now, Time period) override {
    if (!step_) return now;
    const Time passed = std::max(now - *step_, Time::zero());
    return *step_ + (passed + period - Time(1)) / period * period;
  }
  void wait(Time due) override {
    MonotonicClock::sleep_until(due);
    step_ = due;
  }

 private:
  std::optional<Time> step_;  ///< when some tick was, or shall be, due
};

}  // namespace flinch
