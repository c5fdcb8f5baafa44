// A controller of your own in a whole experiment: the robot gives way by it after a contact, and recording,
// verdict and report come as from 'flinch run'. Start it in the root of the tree.
#include <cstdio>

#include "apps/examples/07_own_controller/my_reaction.h"
#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/setup_error.h"

using namespace flinch;

int main() try {
  SimulatedScenario scenario = read_simulated_scenario("apps/scenarios/platform_collision.yaml");
  scenario.control.stages.reaction_laws.follow(my_reaction(1.0, 10.0));

  const RunFolder own = make_run_folder("out/example_07");
  const Verdict verdict =
      conclude_run(scenario, run_experiment(scenario), "out/example_07");  // run.h5, report.html
  std::printf("%s", verdict_table(verdict, {.wall = 0.0, .seed = scenario.seed}).c_str());
  return verdict.good() && verdict.contacts.at(0).removed ? 0 : 1;
} catch (const SetupError& error) {  // says all that is wrong
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
