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
#include "calibration/contact_free_motion.h"
#include "calibration/contact_free_peaks.h"
#include "calibration/drive_deviations.h"
#include "calibration/residual_calibration.h"
#include "calibration/threshold_calibration.h"
#include "calibration/thresholds_output.h"
#include "calibration/written_parameters.h"
#include "experiments/verdict/recorded_sensor_faults.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

namespace {

/// Motions without contact that could be opened, and what those who made them knew of their robots. Of a log
/// the readings at first, then what estimators say over them.
struct FreeMotions {
  std::vector<std::filesystem::path> files{};
  std::vector<Recording> recordings{};
  std::vector<Scenario> scenarios{};
  std::vector<bool> is_log{};  ///< readings of another controller, over which estimators have yet to run
  std::vector<std::vector<bool>> nominal{};  ///< Samples that count, once read.
  std::vector<std::string> problems{};       ///< of those that could not be opened
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

/// Runs the estimators over a log. Its samples count that are free of contact and in motion.
void estimate(Recording& log, const Scenario& scenario, const std::vector<LogTruth::Stretch>& free,
              std::vector<bool>& nominal) {
  log = estimates_of_log(scenario, std::make_shared<const Recording>(std::move(log)));
  nominal = moving_samples(log);
  if (free.empty()) return;
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const double now = to_seconds(Time(log.time_ns[k]));
    nominal[k] = nominal[k] && std::any_of(free.begin(), free.end(), [now](const LogTruth::Stretch& each) {
                   return each.contains(now);
                 });
  }
}

/// Of all estimators. Throws SetupError with all that is wrong with all recordings, also those that could not
/// be opened: told together, be it late.
std::vector<EstimatorPeaks> peaks_of(FreeMotions& motions, const std::vector<LogTruth::Stretch>& free,
                                     const ThresholdGoal& goal, bool quiet) {
  std::vector<std::vector<EstimatorPeaks>> peaks;
  std::vector<std::string> problems = motions.problems;
  motions.nominal.resize(motions.files.size());
  Progress progress("reading recordings", quiet);
  for (std::size_t i = 0; i < motions.files.size(); ++i) {
    try {
      Recording& recording = motions.recordings[i];
      std::vector<bool>& nominal = motions.nominal[i];
      const ConfigurationSpace space = motions.scenarios[i].robot.robot->space();
      peaks.push_back(out_of(motions.files[i], [&] {
        if (!motions.is_log[i]) {
          nominal = nominal_samples(recording, space);
          return contact_free_peaks(recording, space, goal.stretch);
        }
        estimate(recording, motions.scenarios[i], free, nominal);
        return contact_free_peaks(recording, nominal, space, goal.stretch);
      }));
      progress.show(static_cast<double>(i + 1) / static_cast<double>(motions.files.size()));
    } catch (const SetupError& error) {
      append(error, problems);
    }
  }
  throw_if_any(std::move(problems));
  return pooled(peaks);
}

/// Recordings whose robot did without its IMU, so that they tell little of what needs it, one sentence each.
std::vector<std::string> left_out_imus(const FreeMotions& motions) {
  std::vector<std::string> told;
  for (std::size_t i = 0; i < motions.files.size(); ++i) {
    const std::string of_one = told_left_out(imu_left_out(motions.recordings[i]));
    if (!of_one.empty()) told.push_back(motions.files[i].string() + ": " + of_one);
  }
  return told;
}

std::vector<ResidualRecording> residuals_of(const FreeMotions& motions) {
  std::vector<ResidualRecording> recordings;
  for (std::size_t i = 0; i < motions.recordings.size(); ++i)
    recordings.emplace_back(motions.recordings[i], motions.nominal[i], motions.scenarios[i].control);
  return recordings;
}

/// Of the estimators whose residuals a fused detector judges by, as far as they are recorded.
void calibrate_fused_detector(const std::vector<ResidualRecording>& recordings, bool quiet,
                              ThresholdFindings& found) {
  Progress progress("calibrating the fused detector", quiet);
  found.residuals = calibrate_residuals(recordings, found.goal, found.warnings,
                                        [&](double share) { progress.show(share); });
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
  FreeMotions motions = open_motions(options);
  if (motions.problems.empty()) {  // told before hours of recordings are read
    for (const std::filesystem::path& file : motions.files) found.recordings.push_back(source_of(file));
    require_different(found.recordings);
    note_settings(motions.scenarios, found);
  }
  found.estimators =
      calibrate_thresholds(peaks_of(motions, free, found.goal, quiet), found.goal, found.warnings);
  const std::vector<ResidualRecording> residuals = residuals_of(motions);
  for (std::string& warning : left_out_imus(motions)) found.warnings.push_back(std::move(warning));
  calibrate_fused_detector(residuals, quiet, found);
  found.drive_deviations =
      drive_deviations(residuals, *motions.scenarios.front().robot.robot, IsolationSettings().uncertainty);
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
