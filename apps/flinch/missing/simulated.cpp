// What stands in for the simulation in a program that was built without it.
#include "apps/flinch/simulated/simulated_parts.h"
#include "experiments/live/live_experiment.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

LiveExperiment built(const Scenario& scenario) {
  return out_of(scenario.file, [&scenario] { return build_live_experiment(scenario); });
}

}  // namespace

ExitStatus run_simulated(const RunOptions& options) {
  throw SetupError(options.input.string() +
                   ": cannot be simulated, for this flinch was built without the simulation "
                   "(FLINCH_BUILD_PLANT=OFF); choose --station dds or recorded");
}

std::vector<CalibrationWarning> check_campaign(const std::filesystem::path& file) {
  throw SetupError(file.string() +
                   ": its runs are simulated, and this flinch was built without the simulation "
                   "(FLINCH_BUILD_PLANT=OFF)");
}

void check_figures(const std::filesystem::path& file) { check_campaign(file); }

ExitStatus campaign(const CampaignOptions& options) {
  check_campaign(options.file);
  return ExitStatus::done;
}

ExitStatus speed_limit(const SpeedLimitOptions& options) {
  throw SetupError(options.scenario.string() +
                   ": its contacts are simulated, and this flinch was built without the simulation "
                   "(FLINCH_BUILD_PLANT=OFF)");
}

ExitStatus reproduce(const ReproduceOptions& /*options*/) {
  throw SetupError(
      "the papers' figures are simulated, and this flinch was built without the simulation "
      "(FLINCH_BUILD_PLANT=OFF)");
}

std::unique_ptr<Diagram> closed_loop(const std::filesystem::path& scenario) {
  return built(read_scenario(scenario)).diagram;
}

Scenario check_scenario(const std::filesystem::path& file) {
  const Scenario scenario = read_scenario(file);
  built(scenario);
  return scenario;
}

Scenario scenario_of(const Recording& recording, const std::filesystem::path& file,
                     const std::filesystem::path& control) {
  return control.empty() ? recorded_scenario(recording, file) : read_scenario(control);
}

}  // namespace flinch
