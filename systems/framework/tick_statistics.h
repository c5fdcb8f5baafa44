#pragma once

#include <cstdint>

#include "systems/framework/duration_histogram.h"
#include "systems/framework/tick_timing.h"

namespace flinch {

/// How punctual the ticks of real-time runs were, and how long they took. Never allocates.
struct TickStatistics {
  std::int64_t ticks = 0;
  std::int64_t late_starts = 0;
  std::int64_t overruns = 0;      ///< ticks that took longer than their period
  std::int64_t lost_periods = 0;  ///< periods that passed without a tick
  DurationHistogram lateness;
  DurationHistogram evaluation;
  DurationHistogram update;
  DurationHistogram whole;

  void count_start(const TickTiming& timing);
  void count_end(const TickDurations& durations);
};

}  // namespace flinch
