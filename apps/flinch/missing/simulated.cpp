// What stands in for the simulation in a program that was built without it.
#include "apps/flinch/simulated/simulated_parts.h"
#include "experiments/live/live_experiment.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

ExitStatus run_simulated(const RunOptions& options) {
  throw SetupError(options.input.string() +
                   ": cannot be simulated, for this flinch was built without the simulation "
                   "(FLINCH_BUILD_PLANT=OFF); choose --station dds or recorded");
}

void check_campaign(const std::filesystem::path& file) {
  throw SetupError(file.string() +
                   ": its runs are simulated, and this flinch was built without the simulation "
                   "(FLINCH_BUILD_PLANT=OFF)");
}

ExitStatus campaign(const CampaignOptions& options) {
  check_campaign(options.file);
  return ExitStatus::done;
}

std::unique_ptr<Diagram> closed_loop(const std::filesystem::path& scenario) {
  const Scenario read = read_scenario(scenario);
  return out_of(read.file, [&read] { return build_live_experiment(read); }).diagram;
}

Scenario scenario_of(const Recording& recording, const std::filesystem::path& file,
                     const std::filesystem::path& control) {
  return control.empty() ? recorded_scenario(recording, file) : read_scenario(control);
}

}  // namespace flinch
