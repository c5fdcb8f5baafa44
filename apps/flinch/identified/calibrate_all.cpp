// flinch calibrate all: every calibration that a folder of recordings allows, in the order in which they rest
// on one another.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/flinch/identified/calibration_files.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/today.h"
#include "calibration/calibration_output.h"
#include "calibration/calibration_sources.h"
#include "calibration/contact_free_motion.h"
#include "calibration/contact_free_peaks.h"
#include "calibration/drive_deviations.h"
#include "calibration/residual_calibration.h"
#include "calibration/threshold_calibration.h"
#include "calibration/thresholds_output.h"
#include "calibration/written_parameters.h"
#include "diagrams/robot_settings.h"
#include "experiments/recorded/replay.h"
#include "experiments/report/run_folder.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "experiments/verdict/recorded_sensor_faults.h"
#include "identification/dynamics_calibration.h"
#include "identification/imu_pose_calibration.h"
#include "identification/torque_constant_calibration.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_format.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

/// The recordings of a folder by what they are for, which the name of their scenario tells.
struct Sorted {
  std::vector<OpenedRecording> pulls, unseen_pulls, imu, dynamics, motion;

  bool are_none() const { return pulls.empty() && imu.empty() && dynamics.empty() && motion.empty(); }
};

/// Results of campaigns and data sets of contacts, which stand in folders of runs too, say what they are.
bool is_of_another_kind(const std::filesystem::path& file) {
  return hdf5_format(file).starts_with("flinch ");
}

std::vector<std::filesystem::path> recordings_below(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) throw SetupError(folder.string() + ": is no folder");
  std::vector<std::filesystem::path> files;
  try {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file() && entry.path().extension() == ".h5" && !is_of_another_kind(entry.path()))
        files.push_back(entry.path());
    }
  } catch (const std::filesystem::filesystem_error& error) {
    throw SetupError(folder.string() + ": not all folders below it can be read: " + error.code().message());
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) throw SetupError(folder.string() + ": there is no recording (.h5) below it");
  return files;
}

Sorted sorted(std::vector<OpenedRecording> files, std::vector<std::string>& warnings) {
  Sorted result;
  for (OpenedRecording& file : files) {
    const std::string& name = file.scenario.name;
    const auto is_called = [&name](const char* with) { return name.find(with) != std::string::npos; };
    if (is_called("calibration_pulls")) {
      (name.find("second") != std::string::npos ? result.unseen_pulls : result.pulls)
          .push_back(std::move(file));
    } else if (is_called("calibration_rectangle") || is_called("calibration_standstill")) {
      result.imu.push_back(std::move(file));
    } else if (is_called("calibration_excitation")) {
      result.dynamics.push_back(std::move(file));
    } else if (file.scenario.expected.contact == "none") {
      result.motion.push_back(std::move(file));
    } else {
      warnings.push_back(file.source.file +
                         ": is for no calibration and is left out; scenarios of calibrations are "
                         "called calibration_pulls, _rectangle, _standstill, _excitation, and "
                         "others say 'expect: {contact: none}'");
    }
  }
  return result;
}

template <class Kind>
std::vector<Kind> as(const std::vector<OpenedRecording>& files) {
  std::vector<Kind> result;
  for (const OpenedRecording& file : files) {
    Kind& one = result.emplace_back();
    one.source = file.source;
    one.recording = &file.recording;
    if constexpr (requires { one.mountings; }) one.mountings = file.scenario.mountings;
  }
  return result;
}

JointVector found_constants(const CalibrationResult& result, JointVector constant) {
  for (Eigen::Index i = 0; i < constant.size(); ++i)
    constant[i] = result.parameters[static_cast<std::size_t>(i)].value;
  return constant;
}

/// Of all signals those that thresholds come from.
void keep_estimates(Recording& recording) {
  std::erase_if(recording.signals, [](const Signal& signal) {
    return !signal.path.starts_with("wrench") && !signal.path.starts_with("load_") &&
           signal.path != isolation_signal;
  });
}

/// The thresholds that a control path with these calibrations needs, by playing the readings to it again.
ThresholdFindings thresholds_with(const std::vector<OpenedRecording>& motion,
                                  const std::vector<ParameterFile>& calibrations, const ThresholdGoal& goal) {
  ThresholdFindings found{.goal = goal};
  std::vector<Scenario> played;
  for (const OpenedRecording& file : motion) {
    Scenario& scenario = played.emplace_back(file.scenario);
    found.recordings.push_back(file.source);
    if (!calibrations.empty()) {
      scenario.calibrations = calibrations;
      scenario.robot = calibrated_robot(scenario);
      calibrate_control(calibrations, *scenario.robot.robot, scenario.control);
      know_drives(scenario.robot.drives, scenario.control.drive_torque);
    }
  }
  for (const ParameterFile& file : calibrations) found.with.push_back(source_of(file.file));
  note_robot(played, found);
  note_settings(played, found);
  std::vector<std::vector<EstimatorPeaks>> peaks;
  std::vector<Recording> replays(played.size());
  std::vector<ResidualRecording> recordings;
  for (std::size_t i = 0; i < played.size(); ++i) {
    const std::string& file = found.recordings[i].file;
    const ConfigurationSpace space = played[i].robot.robot->space();
    replays[i] = replay(played[i], read_recording(file)).recording;
    out_of(file, [&] {
      peaks.push_back(contact_free_peaks(replays[i], space, goal.stretch));
      recordings.emplace_back(replays[i], nominal_samples(replays[i], space), played[i].control);
    });
    if (const std::string told = told_left_out(imu_left_out(replays[i])); !told.empty())
      found.warnings.push_back(file + ": " + told);
    keep_estimates(replays[i]);
  }
  found.estimators = calibrate_thresholds(pooled(peaks), found.goal, found.warnings);
  found.residuals = calibrate_residuals(recordings, found.goal, found.warnings);
  found.drive_deviations =
      drive_deviations(recordings, *played.front().robot.robot, IsolationSettings().uncertainty);
  found.tracking = played.front().control.fused_detector.tracking;
  return found;
}

class All {
 public:
  explicit All(const CalibrateAllOptions& options)
      : options_(options),
        out_(options.out.empty() ? options.folder / "calibration" : options.out),
        files_(sorted(open_recordings(recordings_below(options.folder), options.common), warnings_)) {}

  const std::filesystem::path& out() const { return out_; }

  ExitStatus run() {
    if (files_.are_none()) {
      warnings_.push_back(options_.folder.string() + ": no recording below it is for a calibration");
      throw SetupError(warnings_);
    }
    const RunFolder folder = make_run_folder(out_);
    Progress progress("calibrating", options_.common.quiet || options_.common.json);
    torque_constants();
    progress.show(0.3);
    dynamics();
    progress.show(0.5);
    imu_pose();
    progress.show(0.7);
    thresholds();
    progress.show(1.0);
    tell_what_is_left_out();
    return ExitStatus::done;
  }

  std::string json() const {
    Json calibrations = Json::array(), recordings = Json::array(), parameters = Json::array();
    Json before = Json::object(), after = Json::object();
    std::vector<std::string> warnings = warnings_;
    for (const CalibrationResult& result : results_) {
      const Json one = Json::parse(calibration_json(result));
      for (const Json& recording : one["recordings"]) recordings.push_back(recording);
      for (const Json& parameter : one["parameters"]) parameters.push_back(parameter);
      before[result.kind] = one["residual_before"];
      after[result.kind] = one["residual_after"];
      warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
      calibrations.push_back(one);
    }
    Json all = {{"kind", "all"},
                {"recordings", recordings},
                {"parameters", parameters},
                {"residual_before", before},
                {"residual_after", after},
                {"warnings", warnings},
                {"calibrations", calibrations}};
    all["thresholds_before"] = threshold_json(before_);
    all["thresholds_after"] = threshold_json(after_);
    return json_text(all);
  }

  std::string table() const {
    std::string text;
    for (const CalibrationResult& result : results_)
      text += fmt::format("== {}\n{}\n", result.kind, calibration_table(result));
    if (!after_.estimators.empty()) text += "== thresholds\n";
    for (std::size_t i = 0; i < after_.estimators.size(); ++i) {
      text += fmt::format("{:<28} {}", after_.estimators[i].estimator, text_of(after_, i));
      if (before_.estimators.size() == after_.estimators.size()) text += "; before " + text_of(before_, i);
      text += "\n";
    }
    return text;
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> all = warnings_;
    for (const CalibrationResult& result : results_)
      all.insert(all.end(), result.warnings.begin(), result.warnings.end());
    for (std::string& warning : flinch::warnings(after_)) all.push_back("thresholds: " + std::move(warning));
    return all;
  }

 private:
  void keep(CalibrationResult result, const Scenario& scenario) {
    require_belief(result, options_.accept);
    const ParameterFile file = write_calibration(result, scenario, out_);
    calibrations_.push_back(file);
    results_.push_back(std::move(result));
  }

  void tell_what_is_left_out() {
    const auto tell = [this](const std::vector<OpenedRecording>& files, const char* kind, const char* need) {
      if (!files.empty()) return;
      warnings_.push_back(fmt::format("{}: not calibrated, for no recording below {} is of {}", kind,
                                      options_.folder.string(), need));
    };
    tell(files_.pulls, "torque-constant", "a scenario called calibration_pulls");
    tell(files_.dynamics, "dynamics", "a scenario called calibration_excitation");
    tell(files_.imu, "imu-pose", "a scenario called calibration_rectangle");
    tell(files_.motion, "thresholds", "motion that expects no contact, as calibration_motion");
  }

  void torque_constants() {
    if (files_.pulls.empty()) return;
    const Scenario& scenario = files_.pulls.front().scenario;
    constant_ = scenario.control.drive_torque.torque_constant;
    CalibrationResult result = calibrate_torque_constants(
        {.robot = scenario.robot.robot.get(), .drives = scenario.robot.drives, .constant = constant_},
        as<PullRecording>(files_.pulls), as<PullRecording>(files_.unseen_pulls));
    constant_ = found_constants(result, constant_);
    keep(std::move(result), scenario);
  }

  void dynamics() {
    if (files_.dynamics.empty()) return;
    const Scenario& scenario = files_.dynamics.front().scenario;
    if (constant_.size() == 0) constant_ = scenario.control.drive_torque.torque_constant;
    CalibrationResult result = calibrate_dynamics({.robot = scenario.robot.robot.get(),
                                                   .drives = scenario.robot.drives,
                                                   .constant = constant_,
                                                   .control_period = scenario.control_period},
                                                  as<MotionRecording>(files_.dynamics), {});
    for (const ParameterFile& file : calibrations_) result.with.push_back(source_of(file.file));
    keep(std::move(result), scenario);
  }

  void imu_pose() {
    if (files_.imu.empty()) return;
    const Scenario& scenario = files_.imu.front().scenario;
    keep(calibrate_imu_pose(*scenario.robot.robot, scenario.control.imu_mount, as<ImuRecording>(files_.imu)),
         scenario);
  }

  void thresholds() {
    if (files_.motion.empty()) return;
    const std::filesystem::path file = out_ / "thresholds.yaml";
    const auto after = possible_thresholds("thresholds: ", calibrations_);
    if (after) {
      after_ = *after;
      write_parameters(file, thresholds_yaml(*after, today()));
      const auto before = possible_thresholds("thresholds before the calibration: ", {});
      if (before) before_ = *before;
    } else if (std::filesystem::exists(file)) {
      warnings_.push_back(file.string() + ": is left as it was, of an earlier calibration; do not use it");
    }
  }

  /// None where the recordings are refused, which is a warning.
  std::optional<ThresholdFindings> possible_thresholds(const std::string& what,
                                                       const std::vector<ParameterFile>& calibrations) {
    try {
      return thresholds_with(
          files_.motion, calibrations,
          {.false_alarms_per_hour = options_.rate, .by_component = options_.by_component, .one_robot = true});
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems()) warnings_.push_back(what + problem);
      return std::nullopt;
    }
  }

  /// "12 N, 1.2 Nm"; by component "[12, 13] N, 1.2 Nm".
  static std::string text_of(const ThresholdFindings& found, std::size_t estimator) {
    const EstimatorThresholds& of = found.estimators[estimator];
    const auto listed = [](const std::vector<double>& values) {
      const std::string all = fmt::format("{:.3g}", fmt::join(values, ", "));
      return values.size() > 1 ? "[" + all + "]" : all;
    };
    const std::vector<double> moment = moment_values(of, found.space);
    const std::string force = listed(force_values(of, found.space)) + " N";
    return moment.empty() ? force : force + ", " + listed(moment) + " Nm";
  }

  static Json threshold_json(const ThresholdFindings& found) {
    Json list = Json::array();
    for (const EstimatorThresholds& of : found.estimators) {
      list.push_back({{"estimator", of.estimator},
                      {"force_N", of.force.value},
                      {"moment_Nm", of.moment.value > 0.0 ? Json(of.moment.value) : Json(nullptr)}});
      if (of.components.empty()) continue;
      list.back()["force_by_component_N"] = force_values(of, found.space);
      list.back()["moment_by_component_Nm"] = moment_values(of, found.space);
    }
    return list;
  }

  const CalibrateAllOptions& options_;
  std::filesystem::path out_;
  std::vector<std::string> warnings_;
  Sorted files_;
  JointVector constant_;
  std::vector<CalibrationResult> results_;
  std::vector<ParameterFile> calibrations_;
  ThresholdFindings before_, after_;
};

}  // namespace

ExitStatus calibrate_all(const CalibrateAllOptions& options) {
  All all(options);
  const ExitStatus status = all.run();
  print_result("{}", options.common.json ? all.json() + "\n" : all.table());
  for (const std::string& warning : all.warnings()) print_message("warning: {}\n", warning);
  if (!options.common.quiet) print_message("parameters: {}\n", all.out().string());
  return status;
}

}  // namespace flinch
