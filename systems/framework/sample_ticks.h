#pragma once

#include <functional>
#include <utility>

#include "systems/framework/tick_source.h"

namespace flinch {

/// Ticks by the robot: each starts when a new sample has come, so that the robot's clock sets the pace and no
/// sample waits. A sample that does not come within `patience` after it was due does not stop the diagram:
/// the tick runs without it and says so, and the next is due one period after this one was. So a diagram
/// notices at its usual rate that its readings grow old. A sample that comes after its tick had to run
/// without it starts one more: the context's time, which counts ticks, is then one period ahead of the
/// samples.
///
///   TripleBuffer<JointReading> received;   // published by the receiving thread, which then calls ...
///   SampleSignal arrived;                  // ... arrived.notify()
///   JointReading latest;
///   SampleTicks ticks([&](Time deadline) {
///     while (!received.take(latest)) {
///       if (!arrived.wait_until(deadline)) return false;
///     }
///     return true;
///   }, 500us);
class SampleTicks : public TickSource {
 public:
  /// Blocks until there is a sample that was not there at its last call, or until MonotonicClock::now()
  /// reaches the deadline; returns whether there is one. With a deadline in the past it only looks. Must not
  /// lock or allocate.
  using Wait = std::function<bool(Time deadline)>;

  /// Sensible for `patience`: more than the jitter of the samples, less than the period.
  SampleTicks(Wait wait_for_sample, Time patience)
      : wait_for_sample_(std::move(wait_for_sample)), patience_(patience) {}

  Time first_due(Time now, Time period) override { return now + period; }
  Wake wait(Time due) override { return wait_for_sample_(due + patience_) ? Wake::sample : Wake::no_sample; }

 private:
  Wait wait_for_sample_;
  Time patience_;
};

}  // namespace flinch
