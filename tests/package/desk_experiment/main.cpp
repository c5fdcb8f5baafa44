#include <cstdio>

#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

/// desk_experiment SCENARIO.yaml FOLDER: simulates an experiment, judges it and leaves its report.
int main(int argc, char** argv) try {
  using namespace flinch;
  if (argc != 3) throw SetupError("usage: desk_experiment SCENARIO.yaml FOLDER");
  const SimulatedScenario scenario = read_simulated_scenario(argv[1]);
  const RunFolder own = make_run_folder(argv[2]);
  const Verdict verdict = conclude_run(scenario, run_experiment(scenario), argv[2]);
  std::printf("%s", verdict_table(verdict, {.wall = 0.0, .seed = scenario.seed}).c_str());
  return verdict.good() && verdict.contacts.size() == 1 ? 0 : 1;
} catch (const flinch::SetupError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
