// What the framework itself costs: a chain of trivial blocks against the same arithmetic written in a loop.
#include <benchmark/benchmark.h>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"
#include "tests/support/blocks.h"

namespace flinch {
namespace {

constexpr int blocks = 100;

std::unique_ptr<Diagram> chain() {
  DiagramBuilder builder("chain");
  OutputPort<double> last = builder.add<test::Counter>("counter").count;
  for (int i = 0; i < blocks; ++i) {
    auto& gain = builder.add<test::Gain>("gain" + std::to_string(i), 1.0001);
    builder.connect(last, gain.in);
    last = gain.out;
  }
  return builder.build();
}

/// Time of one tick, divided by the number of blocks; `per_block` is what is asked to stay below 10 ns.
void FrameworkOverheadPerBlock(benchmark::State& state) {
  const auto diagram = chain();
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

}  // namespace
}  // namespace flinch
