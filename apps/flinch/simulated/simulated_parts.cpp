#include "apps/flinch/simulated/simulated_parts.h"

#include <algorithm>

#include "apps/flinch/conclusion.h"
#include "apps/flinch/fault_options.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/live/shown_run.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/sweep.h"
#include "experiments/report/run_folder.h"
#include "experiments/reproduction/paper_file.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

Experiment built(const SimulatedScenario& scenario) {
  return out_of(scenario.file, [&scenario] { return build_experiment(scenario); });
}

bool was_simulated(const Recording& recording) { return recording.find("truth") != nullptr; }

}  // namespace

ExitStatus run_simulated(const RunOptions& options) {
  if (std::any_of(options.set.begin(), options.set.end(), gives_several_values)) {
    if (options.live.asked())
      throw SetupError("--live: shows one run, and --set with several values makes a sweep");
    return run_sweep(options);
  }
  SimulatedScenario scenario = read_simulated_scenario(options.input, options.set, options.seed);
  add_faults(options.faults, *scenario.robot.robot, scenario.station.faults);
  if (!options.classifier.empty()) classifier_of(options.classifier)(scenario);
  built(scenario);  // before anything is written
  const std::unique_ptr<ShownRun> shown = show_live(options, scenario, ShownPace::ordered);
  const RunFolder folder = folder_of(options, scenario.name);
  const StopWatch watch;
  {
    Progress progress("simulating " + scenario.name, options.common.quiet || options.common.json);
    record_experiment(
        scenario, recording_in(folder), {{"command_line", options.common.command_line}},
        [&progress](double share) { progress.show(share); }, shown ? &shown->spectator() : nullptr);
  }
  const ExitStatus status = conclude(scenario, watch.seconds(), folder, options.common);
  if (shown) shown->finish(folder.path / "report.html");
  return status;
}

std::unique_ptr<Diagram> closed_loop(const std::filesystem::path& scenario) {
  return built(read_simulated_scenario(scenario)).diagram;
}

Scenario check_scenario(const std::filesystem::path& file) {
  const SimulatedScenario scenario = read_simulated_scenario(file);
  built(scenario);
  return static_cast<const Scenario&>(scenario);
}

std::vector<CalibrationWarning> check_campaign(const std::filesystem::path& file) {
  return check_campaign(read_campaign(file));
}

void check_figures(const std::filesystem::path& file) { read_paper_file(file); }

Scenario scenario_of(const Recording& recording, const std::filesystem::path& file,
                     const std::filesystem::path& control) {
  if (!was_simulated(recording)) {
    return control.empty() ? recorded_scenario(recording, file) : read_scenario(control);
  }
  const SimulatedScenario scenario =
      control.empty() ? recorded_simulated_scenario(recording, file) : read_simulated_scenario(control);
  return static_cast<const Scenario&>(scenario);
}

}  // namespace flinch
