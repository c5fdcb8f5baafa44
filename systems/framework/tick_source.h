#pragma once

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/time.h"

namespace flinch {

/// Why a tick starts.
enum class Wake {
  due,        ///< it is time
  sample,     ///< what it waits for has come
  no_sample,  ///< what it waits for has not come in time
};

/// What the ticks of a real-time run wait for, and the clock that they are timed with.
class TickSource {
 public:
  virtual ~TickSource() = default;

  /// The time of a clock that never jumps [ns].
  virtual Time now() { return MonotonicClock::now(); }

  /// Blocks until the tick that is due at `due`, which may have passed, shall start.
  virtual Wake wait(Time due) = 0;
};

/// Ticks by the clock: each starts when it is due.
class ClockTicks final : public TickSource {
 public:
  Wake wait(Time due) override {
    MonotonicClock::sleep_until(due);
    return Wake::due;
  }
};

}  // namespace flinch
