// What the framework itself costs: a chain of trivial blocks against the same arithmetic written in a loop.
#include <benchmark/benchmark.h>

#include <array>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"
#include "tests/bench/chain_of_gains.h"

namespace flinch {
namespace {

constexpr int blocks = 100;

/// Time of one tick, divided by the number of blocks; `per_block` is what is asked to stay below 3 ns.
void FrameworkOverheadPerBlock(benchmark::State& state) {
  const auto diagram = test::chain_of_gains(blocks);
  Simulator simulator(*diagram);
  Context context = diagram->make_context();
  for (auto unused : state) simulator.step(context);
  state.counters["per_block"] =
      benchmark::Counter(blocks, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(FrameworkOverheadPerBlock);

/// The floor: the same multiplications through a pointer to memory.
void FloorPerBlock(benchmark::State& state) {
  std::vector<double> values(blocks + 1, 1.0);
  for (auto unused : state) {
    for (std::size_t i = 0; i < blocks; ++i) values[i + 1] = 1.0001 * values[i];
    benchmark::DoNotOptimize(values.data());
    benchmark::ClobberMemory();
  }
  state.counters["per_block"] =
      benchmark::Counter(blocks, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(FloorPerBlock);

/// Shows its input, every so often.
class Sample final : public System {
 public:
  explicit Sample(Every every) { sampled = output<&Sample::show>(every, "sampled", in); }
  InputPort<double> in = input<double>("in");
  OutputPort<double> sampled;

 private:
  double show(double value) const { return value; }
};

/// The same chain behind a value that is held and changes ten times a second: the mean over all ticks.
void SlowBranchPerBlock(benchmark::State& state) {
  DiagramBuilder builder("slow");
  auto& counter = builder.add<test::Counter>("counter");
  auto& sample = builder.add<Sample>("sample", Every{100ms});
  builder.connect(counter.count, sample.in);
  OutputPort<double> last = sample.sampled;
  for (int i = 0; i < blocks; ++i) {
    auto& gain = builder.add<test::Gain>("gain" + std::to_string(i), 1.0001);
    builder.connect(last, gain.in);
    last = gain.out;
  }
  const auto diagram = builder.build();
  Simulator simulator(*diagram);
  Context context = diagram->make_context();
  for (auto unused : state) simulator.step(context);
  state.counters["per_block"] =
      benchmark::Counter(blocks, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(SlowBranchPerBlock);

/// What a block costs that remembers 3 kB: a state that keeps its output.
class Memory final : public System {
 public:
  struct Value {
    std::array<double, 384> numbers{};
  };

 private:
  State<Value> last_ = state<Value>("last");

 public:
  OutputPort<Value> value = output<&Memory::touch>("value", last_);

 private:
  Update keep_ = keep(last_, value);
  void touch(const Value& last, Value& next) const { next.numbers[0] = last.numbers[0] + 1.0; }
};

void KeepThreeKilobytes(benchmark::State& state) {
  DiagramBuilder builder("memory");
  builder.add<Memory>("memory");
  const auto diagram = builder.build();
  Simulator simulator(*diagram);
  Context context = diagram->make_context();
  for (auto unused : state) simulator.step(context);
}
BENCHMARK(KeepThreeKilobytes);

}  // namespace
}  // namespace flinch
