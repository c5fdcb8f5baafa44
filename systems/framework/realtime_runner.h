#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "systems/framework/simulator.h"
#include "systems/framework/tick_source.h"
#include "systems/framework/tick_statistics.h"
#include "systems/framework/tick_timing.h"

namespace flinch {

class Exchange;

/// Runs a diagram in real time, on the thread that calls run(). It is the diagram that Simulator runs, and
/// with the same inputs it computes the same bits. With the tick period T:
///
///   t := the context's time,  d := when the first tick is due (TickSource::first_due)
///   while t < end and nobody asked to stop, nor is the TickSource over
///     wait until d
///     s := now,  n := floor((s - d) / T)
///     u := the timing of this tick, where an input was named for it, and what exchange.set_inputs() sets
///     y := every output, at t
///     exchange.take_outputs() sees y: here the command leaves
///     recorders see y and u
///     x := updates at t, and integration to t + T, as diagram.h says
///     t := t + T
///     d := d + (n + 1) T
///
/// So a tick is never dropped, and none is run twice as fast to catch up. After an overrun the next tick
/// starts late, but at once; the ticks after it are due when they were before. When n whole periods have
/// passed without a tick, they are lost: counted, told in TickTiming, and t, which counts ticks, is n T
/// further behind the clock. What shall follow from late ticks is decided by blocks, from an input that
/// feed_timing() fills.
///
/// A controller of a real robot does better with a time that does not fall behind: with follow_clock() the
/// tick after n lost periods runs at t + n T, together with all updates and outputs that were due in between
/// (see diagram.h). That is for diagrams without continuous states, which have
/// nothing to integrate over what was lost.
///
/// In steady state the thread allocates nothing and takes no lock. What the machine grants it is asked for
/// apart, and before: see RealtimeThread.
///
///   RealtimeThread thread(settings);             // throws where something required is not permitted
///   show(thread.report());
///   ClockTicks ticks;
///   RealtimeRunner runner(diagram, ticks, exchange);
///   runner.record(recorder);
///   runner.run(context, 10s);
class RealtimeRunner {
 public:
  /// A tick that starts later than this after it was due, or than half a period, is late.
  static constexpr Time late_start = 500us;

  /// All references must outlive the runner. The default integrator is that of Simulator.
  RealtimeRunner(const Diagram& diagram, TickSource& ticks, Exchange& exchange,
                 std::unique_ptr<Integrator> integrator = nullptr);

  /// As Simulator::record().
  void record(Recorder& recorder) { simulator_.record(recorder); }
  /// As Simulator::profile().
  void profile(BlockProfile& profile) { simulator_.profile(profile); }

  /// Before each tick, sets `input` of the diagram itself to the tick's timing. Throws SetupError for an
  /// input of a block inside.
  void feed_timing(InputPort<TickTiming> input);

  /// Lets the time of ticks skip what was lost. Throws SetupError for a diagram with continuous states.
  void follow_clock();

  /// Runs ticks until the context's time reaches `end`, a tick has brought about what `done` asks for, or
  /// somebody asks to stop. `done` is called on this thread after each tick and may not allocate, lock or
  /// block.
  void run(Context& context, Time end = Time::max(), const std::function<bool()>& done = {});

  /// Lets run() return after the current tick, for good. From any thread or signal handler.
  void request_stop() noexcept { stop_requested_.store(true, std::memory_order_relaxed); }
  bool stop_requested() const noexcept { return stop_requested_.load(std::memory_order_relaxed); }

  /// Of all runs. Not to be read while one is under way.
  const TickStatistics& statistics() const { return statistics_; }
  /// As Simulator::inaccurate_steps().
  std::int64_t inaccurate_steps() const { return simulator_.inaccurate_steps(); }

 private:
  TickTiming time_start(Time due, const TickDurations& previous);
  TickDurations tick(Context& context, const TickTiming& timing);

  static_assert(std::atomic<bool>::is_always_lock_free);

  const Diagram& diagram_;
  TickSource& ticks_;
  Exchange& exchange_;
  Simulator simulator_;
  std::optional<Slot<TickTiming>> timing_slot_;
  bool follows_clock_ = false;
  TickStatistics statistics_;
  std::atomic<bool> stop_requested_ = false;
};

}  // namespace flinch
