#include "apps/flinch/identified/calibration_files.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "apps/flinch/conclusion.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "apps/flinch/today.h"
#include "calibration/calibration_output.h"
#include "calibration/calibration_page.h"
#include "calibration/calibration_sources.h"
#include "calibration/written_parameters.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void note_robot(const Scenario& scenario, CalibrationResult& result) {
  result.robot_file = scenario.robot_file.string();
  result.robot_sha256 = calibrated_robot_hash(scenario.robot_text);
}

}  // namespace

void require_belief(CalibrationResult& result, bool accept) {
  if (result.contradictions.empty()) return;
  if (accept) {
    result.warnings.insert(result.warnings.begin(), result.contradictions.begin(),
                           result.contradictions.end());
    return;
  }
  std::vector<std::string> problems = result.contradictions;
  problems.push_back(
      "nothing was written; mend the recording or the belief, or take it as it is by --accept");
  throw SetupError(problems);
}

std::vector<OpenedRecording> open_recordings(const std::vector<std::filesystem::path>& files,
                                             const CommonOptions& common) {
  std::vector<OpenedRecording> opened;
  std::vector<std::string> problems;
  for (const std::filesystem::path& file : files) {
    try {
      require_no_kind(file, "a recording");
      OpenedRecording one{{}, open_recording(file), {}};
      tell_if_partial(one.recording, common);
      one.source = source_of(file);
      one.scenario = recorded_scenario(one.recording, file);
      opened.push_back(std::move(one));
      if (opened.back().scenario.robot_text == opened.front().scenario.robot_text) continue;
      problems.push_back(file.string() + ": was recorded of another robot file than " +
                         opened.front().source.file + "; calibrate each robot by itself");
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
  std::vector<CalibrationSource> sources;
  for (const OpenedRecording& one : opened) sources.push_back(one.source);
  require_different(sources);
  return opened;
}

CalibrationRecordings open_recordings(const CalibrateOptions& options) {
  std::vector<std::filesystem::path> files = options.recordings;
  files.insert(files.end(), options.unseen.begin(), options.unseen.end());
  CalibrationRecordings opened{open_recordings(files, options.common), {}};
  const auto unseen = opened.used.begin() + static_cast<std::ptrdiff_t>(options.recordings.size());
  std::move(unseen, opened.used.end(), std::back_inserter(opened.unseen));
  opened.used.erase(unseen, opened.used.end());
  if (!options.common.quiet && !options.common.json) {
    double seconds = 0.0;
    for (const OpenedRecording& each : opened.used)
      seconds += static_cast<double>(each.recording.samples()) * to_seconds(each.recording.period);
    print_message("fitting to {:.1f} s of recorded samples ...\n", seconds);
  }
  return opened;
}

namespace {

std::filesystem::path page_beside(const std::filesystem::path& file) {
  return std::filesystem::path(file).replace_extension(".html");
}

/// Throws SetupError where the robot file with what was found would be refused.
void require_use(const CalibrationResult& result, const Scenario& scenario,
                 const std::filesystem::path& file) {
  Scenario calibrated = scenario;
  calibrated.calibrations.push_back(parse_parameter_file(calibration_yaml(result, today()), file.string()));
  out_of(file.string() + ": is not written, for no robot could have what was found",
         [&] { return calibrated_robot(calibrated); });
}

/// The parameter file, and beside it the page of the same name, which is returned.
std::filesystem::path write_files(const CalibrationResult& result, const Scenario& scenario,
                                  const std::filesystem::path& file) {
  const std::filesystem::path page = page_beside(file);
  require_use(result, scenario, file);
  write_parameters(file, calibration_yaml(result, today()));
  write_result(page, calibration_page(result, today()));
  return page;
}

}  // namespace

void require_places(const CalibrateOptions& options) {
  if (options.out.empty()) return;
  if (options.out.extension() == ".html")
    throw SetupError(options.out.string() + ": is the name of the page; call the parameter file .yaml");
  std::vector<std::filesystem::path> inputs = options.recordings;
  inputs.insert(inputs.end(), options.unseen.begin(), options.unseen.end());
  inputs.insert(inputs.end(), options.with.begin(), options.with.end());
  require_output(options.out, inputs, OutputKind::parameters);
  require_output(page_beside(options.out), inputs, OutputKind::page);
}

JointVector calibrated_constants(const Scenario& scenario, const std::vector<std::filesystem::path>& files) {
  if (files.empty()) return scenario.control.drive_torque.torque_constant;
  Scenario calibrated = scenario;
  for (const std::filesystem::path& file : files) {
    calibrated.calibrations.push_back(read_parameter_file(file));
    if (calibrated.calibrations.back().kind == "torque-constant") continue;
    throw SetupError(file.string() + ": is of kind '" + calibrated.calibrations.back().kind +
                     "'; only torque constants are used, kind 'torque-constant'");
  }
  return calibrated_robot(calibrated).drives.torque_constant;
}

ParameterFile write_calibration(CalibrationResult& result, const Scenario& scenario,
                                const std::filesystem::path& folder) {
  note_robot(scenario, result);
  std::string name = result.kind;
  std::replace(name.begin(), name.end(), '-', '_');
  const std::filesystem::path file = folder / (name + ".yaml");
  write_files(result, scenario, file);
  return read_parameter_file(file);
}

ExitStatus conclude_calibration(CalibrationResult& result, const Scenario& scenario,
                                const CalibrateOptions& options) {
  require_belief(result, options.accept);
  note_robot(scenario, result);
  for (const std::filesystem::path& file : options.with) result.with.push_back(source_of(file));
  print_result("{}", options.common.json ? calibration_json(result) + "\n" : calibration_table(result));
  for (const std::string& warning : result.warnings) print_message("warning: {}\n", warning);
  if (!options.out.empty()) {
    const std::filesystem::path page = write_files(result, scenario, options.out);
    if (!options.common.quiet)
      print_message("parameters: {}\nreport:     {}\n", options.out.string(), page.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
