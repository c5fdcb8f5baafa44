// flinch calibrate: parameters from recordings.
#include <fmt/core.h>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "calibration/contact_free_peaks.h"
#include "calibration/threshold_calibration.h"
#include "calibration/thresholds_output.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

ExitStatus calibrate_thresholds(const CalibrateThresholdsOptions& options) {
  ThresholdGoal goal;
  goal.false_alarms_per_hour = options.rate;
  goal.confidence = options.confidence;
  goal.safety_factor = options.safety_factor;
  std::vector<std::vector<EstimatorPeaks>> peaks;
  std::vector<std::string> problems, names;
  for (const std::filesystem::path& file : options.recordings) {
    names.push_back(file.string());
    try {
      const Recording recording = open_recording(file);
      tell_if_partial(recording, options.common);
      const Scenario scenario = scenario_of(recording, file);
      peaks.push_back(out_of(
          file, [&] { return contact_free_peaks(recording, scenario.robot.robot->space(), goal.stretch); }));
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
  const std::vector<EstimatorThresholds> thresholds = calibrate_thresholds(pooled(peaks), goal);
  fmt::print("{}", options.common.json ? thresholds_json(thresholds, goal) + "\n"
                                       : thresholds_table(thresholds, goal));
  if (options.out.empty()) return ExitStatus::done;
  write_result(options.out, thresholds_yaml(thresholds, goal, names));
  if (!options.common.quiet) fmt::print(stderr, "thresholds: {}\n", options.out.string());
  return ExitStatus::done;
}

}  // namespace flinch
