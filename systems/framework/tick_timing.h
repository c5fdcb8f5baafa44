#pragma once

#include <cstdint>

#include "systems/framework/time.h"

namespace flinch {

/// How long a tick of a real-time run took.
struct TickDurations {
  bool valid = false;
  bool overran = false;  ///< the whole tick took longer than its period
  Time evaluation{};  ///< from its start until the outputs had been taken away [ns]: what a command waits for
  Time update{};      ///< from then to its end: recorders, updates, integration [ns]
  Time whole{};       ///< both [ns]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("overran", "", self.overran);
    visit("evaluation", "ns", self.evaluation);
    visit("update", "ns", self.update);
    visit("whole", "ns", self.whole);
  }
};

/// When a tick of a real-time run started. RealtimeRunner::feed_timing() puts it into an input of the
/// diagram, so that blocks can act upon it, and a recording shows every tick that was late. Never valid in
/// simulated time.
struct TickTiming {
  bool valid = false;
  bool late = false;              ///< by more than RealtimeRunner::late_start
  std::int64_t lost_periods = 0;  ///< whole periods that passed without a tick since it was due
  Time started{};                 ///< time of the tick source's clock (CLOCK_MONOTONIC) [ns]
  Time lateness{};                ///< of the start, since it was due [ns]
  TickDurations previous;         ///< of the tick before; not valid at the first

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("late", "", self.late);
    visit("lost_periods", "", self.lost_periods);
    visit("started", "ns", self.started);
    visit("lateness", "ns", self.lateness);
    visit("previous", "", self.previous);
  }
};

}  // namespace flinch
