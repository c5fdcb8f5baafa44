// Scenarios, with the robot that they name.
#include "experiments/simulated/simulated_scenario.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

void read(std::string_view bytes) {
  parse_simulated_scenario(std::string(bytes), FLINCH_SOURCE_DIR "/apps/scenarios/fuzzed.yaml");
}

std::vector<std::string> seeds() { return shipped_files("scenarios", ".yaml"); }

}  // namespace

const FuzzTarget scenario_target{"scenario", read, seeds};

}  // namespace flinch::test
