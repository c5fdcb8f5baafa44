// flinch calibrate: parameters from recordings.
#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/log_stretch.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "apps/flinch/today.h"
#include "calibration/calibration_sources.h"
#include "calibration/contact_free_peaks.h"
#include "calibration/threshold_calibration.h"
#include "calibration/thresholds_output.h"
#include "calibration/written_parameters.h"
#include "diagrams/fused_detector.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

namespace {

/// The recordings that could be opened, and what those who made them knew of their robots.
struct FreeMotions {
  std::vector<std::filesystem::path> files{};
  std::vector<Recording> recordings{};
  std::vector<Scenario> scenarios{};
  std::vector<bool> is_log{};  ///< readings of another controller, over which estimators have yet to run
  std::vector<std::string> problems{};  ///< of the others
};

void append(const SetupError& error, std::vector<std::string>& problems) {
  problems.insert(problems.end(), error.problems().begin(), error.problems().end());
}

FreeMotions open_motions(const CalibrateThresholdsOptions& options) {
  FreeMotions opened;
  for (const std::filesystem::path& file : options.recordings) {
    try {
      require_no_kind(file, "a recording");
      Recording recording = open_recording(file);
      tell_if_partial(recording, options.common);
      opened.is_log.push_back(holds_readings_alone(recording));
      opened.scenarios.push_back(opened.is_log.back() && !options.scenario.empty()
                                     ? read_scenario(options.scenario)
                                     : scenario_of(recording, file));
      opened.files.push_back(file);
      opened.recordings.push_back(std::move(recording));
    } catch (const SetupError& error) {
      append(error, opened.problems);
    }
  }
  return opened;
}

/// Of a log, by running the estimators over it.
std::vector<EstimatorPeaks> peaks_of_log(const Recording& log, const Scenario& scenario,
                                         const std::vector<LogTruth::Stretch>& free, Time stretch) {
  const Recording estimates = estimates_of_log(scenario, std::make_shared<const Recording>(log));
  std::vector<bool> counts(estimates.samples(), free.empty());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double now = to_seconds(Time(estimates.time_ns[k]));
    for (const LogTruth::Stretch& each : free) counts[k] = counts[k] || each.contains(now);
  }
  return contact_free_peaks(estimates, counts, scenario.robot.robot->space(), stretch);
}

/// Of all estimators. Throws SetupError with all that is wrong with all recordings, also those that could not
/// be opened: told together, be it late.
std::vector<EstimatorPeaks> peaks_of(const FreeMotions& motions, const std::vector<LogTruth::Stretch>& free,
                                     const ThresholdGoal& goal, bool quiet) {
  std::vector<std::vector<EstimatorPeaks>> peaks;
  std::vector<std::string> problems = motions.problems;
  Progress progress("reading recordings", quiet);
  for (std::size_t i = 0; i < motions.files.size(); ++i) {
    try {
      peaks.push_back(out_of(motions.files[i], [&] {
        const Scenario& scenario = motions.scenarios[i];
        if (motions.is_log[i]) return peaks_of_log(motions.recordings[i], scenario, free, goal.stretch);
        return contact_free_peaks(motions.recordings[i], scenario.robot.robot->space(), goal.stretch);
      }));
      progress.show(static_cast<double>(i + 1) / static_cast<double>(motions.files.size()));
    } catch (const SetupError& error) {
      append(error, problems);
    }
  }
  throw_if_any(std::move(problems));
  return pooled(peaks);
}

/// Of the estimators whose residuals a fused detector judges by, as far as they are recorded.
std::vector<CalibratedResidual> residuals_of(const FreeMotions& motions, const ThresholdGoal& goal,
                                             bool quiet) {
  const std::vector<std::string> judged{"disturbance_filter", "imu_residual"};
  std::vector<ResidualRecording> recordings;
  for (std::size_t i = 0; i < motions.recordings.size(); ++i) {
    if (motions.is_log[i]) return {};  // whose loads of the drives nobody has recorded
    const Scenario& scenario = motions.scenarios[i];
    ResidualRecording recording{&motions.recordings[i], scenario.robot.robot->space(), {}};
    for (const std::string& name : judged) recording.tracking[name] = tracking_of(name, scenario.control);
    recordings.push_back(recording);
  }
  const std::vector<std::string> estimators = calibrated_residuals(recordings, judged);
  if (estimators.empty()) return {};
  Progress progress("calibrating the fused detector", quiet);
  return calibrate_residuals(recordings, estimators, goal, [&](double share) { progress.show(share); });
}

}  // namespace

ExitStatus calibrate_thresholds(const CalibrateThresholdsOptions& options) {
  require_output(options.out, options.recordings, OutputKind::parameters);
  ThresholdFindings found;
  found.goal.false_alarms_per_hour = options.rate;
  found.goal.confidence = options.confidence;
  found.goal.safety_factor = options.safety_factor;
  found.goal.by_component = options.by_component;
  found.goal.one_robot = options.one_robot;
  const bool quiet = options.common.quiet || options.common.json;
  const std::vector<LogTruth::Stretch> free = stretches_of(options.free);
  const FreeMotions motions = open_motions(options);
  if (motions.problems.empty()) {  // told before hours of recordings are read
    for (const std::filesystem::path& file : motions.files) found.recordings.push_back(source_of(file));
    require_different(found.recordings);
    note_settings(motions.scenarios, found);
  }
  found.estimators = calibrate_thresholds(peaks_of(motions, free, found.goal, quiet), found.goal);
  found.residuals = residuals_of(motions, found.goal, quiet);
  found.tracking = motions.scenarios.front().control.fused_detector.tracking;
  note_robot(motions.scenarios, found);
  print_result("{}", options.common.json ? thresholds_json(found) + "\n" : thresholds_table(found));
  for (const std::string& warning : warnings(found)) print_message("warning: {}\n", warning);
  if (options.out.empty()) return ExitStatus::done;
  write_parameters(options.out, thresholds_yaml(found, today()));
  if (!options.common.quiet) print_message("thresholds: {}\n", options.out.string());
  return ExitStatus::done;
}

}  // namespace flinch
