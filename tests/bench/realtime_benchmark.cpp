// What real time costs a tick, and how late 1 kHz ticks start on this machine: idle or busy, as an ordinary
// thread or as a control thread. The floor of lateness is a bare loop of clock_nanosleep under the same
// conditions.
#include <benchmark/benchmark.h>

#include <atomic>
#include <thread>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/exchange.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/realtime_thread.h"
#include "systems/framework/triple_buffer.h"
#include "tests/bench/chain_of_gains.h"

namespace flinch {
namespace {

constexpr int blocks = 100;
constexpr int ticks_in_run = 5000;

/// Never waits.
class EagerTicks final : public TickSource {
 public:
  void wait(Time) override {}
};

/// A tick of a runner that does not wait, against `SimulatedTick`: clock readings and statistics.
void RealtimeTick(benchmark::State& state) {
  const auto diagram = test::chain_of_gains(blocks);
  EagerTicks ticks;
  Exchange nothing;
  RealtimeRunner runner(*diagram, ticks, nothing);
  Context context = diagram->make_context();
  for (auto unused : state) runner.run(context, context.time() + 100ms);
  state.counters["per_tick"] =
      benchmark::Counter(100, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(RealtimeTick);

void SimulatedTick(benchmark::State& state) {
  const auto diagram = test::chain_of_gains(blocks);
  Simulator simulator(*diagram);
  Context context = diagram->make_context();
  for (auto unused : state) simulator.step(context);
  state.counters["per_tick"] =
      benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(SimulatedTick);

/// Publishing and taking 128 bytes, in one thread.
void TripleBufferHandOver(benchmark::State& state) {
  TripleBuffer<std::array<double, 16>> buffer;
  std::array<double, 16> value{};
  for (auto unused : state) {
    value[0] += 1.0;
    buffer.publish(value);
    benchmark::DoNotOptimize(buffer.take(value));
  }
}
BENCHMARK(TripleBufferHandOver);

/// Keeps every processor busy with ordinary threads while it lives, where wanted.
class Load {
 public:
  explicit Load(bool wanted) {
    for (unsigned i = 0; wanted && i < std::thread::hardware_concurrency(); ++i) {
      threads_.emplace_back([this] {
        while (!ending_.load(std::memory_order_relaxed)) continue;
      });
    }
  }
  ~Load() {
    ending_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> ending_ = false;
  std::vector<std::thread> threads_;
};

DurationHistogram lateness_of_runner() {
  const auto diagram = test::chain_of_gains(blocks);
  ClockTicks ticks;
  Exchange nothing;
  RealtimeRunner runner(*diagram, ticks, nothing);
  Context context = diagram->make_context();
  runner.run(context, ticks_in_run * diagram->tick());
  return runner.statistics().lateness;
}

DurationHistogram lateness_of_bare_loop() {
  DurationHistogram lateness;
  Time due = MonotonicClock::now();
  for (int k = 0; k < ticks_in_run; ++k) {
    MonotonicClock::sleep_until(due);
    lateness.add(MonotonicClock::now() - due);
    due += 1ms;
  }
  return lateness;
}

/// Lateness of starts [us].
void Lateness(benchmark::State& state, DurationHistogram (*run)()) {
  const bool control_thread = state.range(0) != 0;
  const Load load(state.range(1) != 0);
  const Requirement wish = control_thread ? Requirement::prefer : Requirement::none;
  const RealtimeThread thread(
      {.scheduling = wish, .locked_memory = wish, .realtime_kernel = Requirement::none});
  if (!thread.report().all_granted()) return state.SkipWithError(thread.report().text().c_str());

  DurationHistogram lateness;
  for (auto unused : state) lateness = run();
  const DurationSummary summary = lateness.summary().value();
  const auto microseconds = [](Time time) { return 1e6 * to_seconds(time); };
  state.counters["p50"] = microseconds(summary.p50);
  state.counters["p99"] = microseconds(summary.p99);
  state.counters["p99_9"] = microseconds(summary.p99_9);
  state.counters["max"] = microseconds(summary.max);
}

void conditions(benchmark::internal::Benchmark* lateness) {
  lateness->ArgNames({"control_thread", "busy"})->ArgsProduct({{0, 1}, {0, 1}});
  lateness->Iterations(1)->Unit(benchmark::kSecond);
}
BENCHMARK_CAPTURE(Lateness, floor, lateness_of_bare_loop)->Apply(conditions);
BENCHMARK_CAPTURE(Lateness, runner, lateness_of_runner)->Apply(conditions);

}  // namespace
}  // namespace flinch
