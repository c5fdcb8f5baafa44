// An observer of your own in a whole experiment: it stands beside flinch's, detector and reaction follow it,
// and recording, verdict and report come as from 'flinch run'. Start it in the root of the tree.
#include <cstdio>

#include "apps/examples/05_own_observer/my_observer.h"
#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/setup_error.h"

using namespace flinch;

static double delay(const Verdict& seen) {
  const ContactVerdict& contact = seen.contacts.at(0);
  return contact.detected.value_or(1.0) - contact.onset;
}

int main() try {
  SimulatedScenario scenario = read_simulated_scenario("apps/scenarios/platform_collision.yaml");
  const Verdict flinchs_own = judge_experiment(scenario);
  scenario.control.stages.estimators.follow(my_observer(40.0));  // twice as fast as flinch's of this scenario

  const RunFolder own = make_run_folder("out/example_05");
  const Verdict verdict =
      conclude_run(scenario, run_experiment(scenario), "out/example_05");  // run.h5, report.html
  std::printf("%s", verdict_table(verdict, {.wall = 0.0, .seed = scenario.seed}).c_str());
  std::printf("my observer: %.1f ms, flinch's: %.1f ms\n", 1e3 * delay(verdict), 1e3 * delay(flinchs_own));
  return verdict.good() && delay(verdict) < delay(flinchs_own) ? 0 : 1;
} catch (const SetupError& error) {  // says all that is wrong
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
