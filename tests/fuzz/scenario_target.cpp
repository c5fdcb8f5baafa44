// Scenarios. The robots that they name are read once, since their reader has a target of its own.
#include "experiments/scenario/robot_files.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/config/config_node.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

void try_scenario(std::string_view bytes) {
  static RobotFiles robots;
  const std::string file = FLINCH_SOURCE_DIR "/apps/scenarios/fuzzed.yaml";
  parse_simulated_scenario(parse_yaml(bytes, file), file, robots);
}

std::vector<std::string> scenario_seeds() { return shipped_files("scenarios", ".yaml"); }

}  // namespace

const FuzzTarget scenario_target{"scenario", try_scenario, scenario_seeds};

}  // namespace flinch::test
