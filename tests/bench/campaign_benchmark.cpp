// A run of a campaign: drawn, built, simulated for 1.2 s and judged, without page or recording.
// `per_4_cores` is how many four processors do in a second, by the processor time that a run takes, whatever
// else the machine does. `efficiency` is that of whole campaigns in parallel: runs a second of processor time
// with a thread for each processor, over those with one; `busy` is the share of the processors' time that it
// used meanwhile, which other programs make smaller.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <thread>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/run_campaign.h"
#include "tests/support/temporary_folder.h"

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

struct Used {
  double processor = 0.0;  ///< seconds, of all threads
  double wall = 0.0;
};

/// What a campaign takes from its first run to its tables.
Used time_of(const Campaign& campaign, std::size_t threads) {
  const test::TemporaryFolder folder;
  const std::clock_t processor = std::clock();
  const auto wall = std::chrono::steady_clock::now();
  run_campaign(campaign, folder.path(), threads);
  return {static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count()};
}

void campaign_in_parallel(benchmark::State& state) {
  const Campaign campaign =
      read_campaign(FLINCH_SOURCE_DIR "/apps/campaigns/random_contacts.yaml", {.draws = 20});
  const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
  Used alone, together;
  for (auto _ : state) {
    const Used one = time_of(campaign, 1), all = time_of(campaign, processors);
    alone.processor += one.processor;
    together.processor += all.processor;
    together.wall += all.wall;
  }
  state.counters["efficiency"] = alone.processor / together.processor;
  state.counters["busy"] = together.processor / (together.wall * static_cast<double>(processors));
}

BENCHMARK(campaign_in_parallel)->Unit(benchmark::kSecond)->Iterations(1);
BENCHMARK_CAPTURE(run_of_a_campaign, of_robots_like_their_model, "none")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_of_a_campaign, of_realistic_robots, "bench")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flinch
