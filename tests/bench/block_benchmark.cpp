// Where a simulated millisecond of the closed loop goes: what each block of a scenario costs in a tick, as
// its mean and, since all must be done in time, in its dearest stretch of 20 ms. A run is the same each time,
// so that of every stretch the best of all runs counts. Every number contains a reading of the clock a call.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/block_profile.h"
#include "systems/framework/simulator.h"

namespace flinch {
namespace {

constexpr int stretch = 20;  // [ticks]

/// What each block takes of a tick, stretch by stretch [ns].
using Costs = std::map<std::string, std::vector<double>>;

void add_run(const SimulatedScenario& scenario, const Diagram& diagram, Costs& costs) {
  Simulator simulator(diagram, std::make_unique<SundialsIntegrator>());
  Context context = diagram.make_context();
  for (std::size_t number = 0; context.time() < scenario.duration; ++number) {
    BlockProfile profile(diagram);
    simulator.profile(profile);
    for (int tick = 0; tick < stretch; ++tick) simulator.step(context);
    for (const BlockProfile::Row& row : profile.rows()) {
      std::vector<double>& best = costs[row.path];
      const double took = static_cast<double>(row.total.count()) / stretch;
      if (number == best.size()) best.push_back(took);
      best[number] = std::min(best[number], took);
    }
  }
}

void BlocksOfClosedLoop(benchmark::State& state, const std::string& name) {
  const SimulatedScenario scenario =
      read_simulated_scenario(FLINCH_SOURCE_DIR "/apps/scenarios/" + name + ".yaml");
  const Experiment experiment = build_experiment(scenario);
  Costs costs;
  for (auto unused : state) add_run(scenario, *experiment.diagram, costs);
  for (const auto& [path, of_stretch] : costs) {
    const std::string block = path.substr(path.find('/') + 1);
    double sum = 0.0;
    for (const double each : of_stretch) sum += each;
    state.counters[block + "_ns"] = sum / static_cast<double>(of_stretch.size());
    state.counters[block + "_ns_most"] = *std::max_element(of_stretch.begin(), of_stretch.end());
  }
}
BENCHMARK_CAPTURE(BlocksOfClosedLoop, square, "square")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BlocksOfClosedLoop, square_realistic, "square_realistic")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BlocksOfClosedLoop, platform_collision, "platform_collision")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BlocksOfClosedLoop, clamping, "clamping")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flinch
