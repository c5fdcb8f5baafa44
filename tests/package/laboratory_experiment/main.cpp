#include <cstdio>
#include <string>

#include "drivers/dds_bus.h"
#include "experiments/bus/live_run.h"
#include "experiments/recorded/replay.h"
#include "experiments/report/run_folder.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"

namespace {

using namespace flinch;

/// Gives the readings of a recorded run to the same control path again, and judges what it makes of them.
bool is_replayed(const std::string& file, const std::string& folder) {
  const Recording recorded = read_recording(file);
  const Scenario scenario = recorded_scenario(recorded, file);
  const Replay replayed = replay(scenario, recorded);
  const RunFolder own = make_run_folder(folder);
  const Verdict verdict = conclude_run(scenario, replayed.recording, folder);
  std::printf("replayed: %zu signals differ, the verdict is %s\n", replayed.differing.size(),
              verdict.good() ? "good" : "bad");
  return replayed.differing.empty() && verdict.good();
}

/// Runs the scenario against the robot on the bus; here there is none, and the run says so. free_domain() of
/// the other tests never gives this domain.
bool asks_for_the_robot(const std::string& scenario, const std::string& folder) {
  try {
    run_live_experiment(read_scenario(scenario), DdsBus({.domain = 100, .interface = "lo"}),
                        folder + "/live.h5", {.patience = 200ms});
  } catch (const SetupError& error) {
    std::printf("live: %s\n", error.what());
    return std::string(error.what()).find("nobody sends joint readings") != std::string::npos;
  }
  return false;
}

}  // namespace

/// laboratory_experiment SCENARIO.yaml RUN.h5 FOLDER
int main(int argc, char** argv) try {
  if (argc != 4) throw SetupError("usage: laboratory_experiment SCENARIO.yaml RUN.h5 FOLDER");
  return is_replayed(argv[2], argv[3]) && asks_for_the_robot(argv[1], argv[3]) ? 0 : 1;
} catch (const SetupError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
