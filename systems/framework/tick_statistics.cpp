#include "systems/framework/tick_statistics.h"

namespace flinch {

void TickStatistics::count_start(const TickTiming& timing) {
  ++ticks;
  if (timing.late) ++late_starts;
  lost_periods += timing.lost_periods;
  lateness.add(timing.lateness);
}

void TickStatistics::count_end(const TickDurations& durations) {
  if (durations.overran) ++overruns;
  evaluation.add(durations.evaluation);
  update.add(durations.update);
  whole.add(durations.whole);
}

}  // namespace flinch
