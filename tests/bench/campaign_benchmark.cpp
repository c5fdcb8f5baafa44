// A run of a campaign: drawn, built, simulated for 1.2 s and judged, without page or recording.
// `per_4_cores` is how many four processors do in a second, by the processor time that a run takes, whatever
// else the machine does.
#include <benchmark/benchmark.h>

#include <string>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/run_campaign.h"

namespace flinch {
namespace {

/// Random contacts with every sort of body, of robots as their model or as real ones, as `realism` says.
void run_of_a_campaign(benchmark::State& state, const std::string& realism) {
  const Campaign campaign = read_campaign(FLINCH_SOURCE_DIR "/apps/campaigns/random_contacts.yaml",
                                          {.set = {"plant.realism=" + realism}, .draws = 50});
  std::size_t number = 0;
  for (auto _ : state) benchmark::DoNotOptimize(simulate_run(draw_run(campaign, number++ % campaign.runs())));
  state.counters["per_4_cores"] = benchmark::Counter(4.0, benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(run_of_a_campaign, of_robots_like_their_model, "none")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_of_a_campaign, of_realistic_robots, "bench")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flinch
