// What the verbs do that only look at files.
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "experiments/recorded/judged_log.h"
#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/robot_check/robot_summary.h"
#include "experiments/robot_check/robot_warnings.h"
#include "experiments/robot_check/workspace_picture.h"
#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "import/imported_recording.h"
#include "systems/config/config_file.h"
#include "systems/config/file_kind.h"
#include "systems/config/parameter_file.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"
#include "systems/framework/hdf5_format.h"
#include "systems/framework/recording.h"
#include "systems/framework/recording_file.h"
#include "systems/framework/recording_journal.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Report recorded_report(const std::filesystem::path& file, const CommonOptions& common) {
  require_no_kind(file, "a recording");
  const Recording recording = open_recording(file);
  tell_if_partial(recording, common);
  const Scenario scenario = scenario_of(recording, file);
  require_run(recording, file);
  Progress progress("judging " + file.string(), is_short(recording) || common.quiet || common.json);
  return out_of(file, [&] {
    return judged_report(scenario, recording, [&progress](double share) { progress.show(share); }).second;
  });
}

/// The kind of a good file, and what to know of it.
struct Checked {
  std::string what;
  std::vector<CalibrationWarning> warnings = {};
  std::vector<std::string> robot_warnings = {};
  std::optional<RobotFile> robot = {};  ///< Of a robot file.
};

/// Checks a file of HDF5, and says of which kind it is.
std::string check_results(const std::filesystem::path& file, const CommonOptions& common) {
  const std::string format = hdf5_format(file);
  if (format == "flinch campaign") return "campaign results";
  if (format.starts_with("flinch contacts")) {
    check_data_set(file);
    return "data set";
  }
  const Recording recording = open_recording(file);
  const bool readings = holds_readings_alone(recording);
  if (readings) {
    scenario_of(recording, file);
  } else {
    recorded_report(file, common);
  }
  out_of(file, [&] { read_every_row(recording); });  // a page and a verdict read some only
  return readings ? "readings" : "recording";
}

/// The same of YAML.
Checked check_text(const std::filesystem::path& file) {
  switch (kind_of(file).value_or(FileKind::scenario)) {
    case FileKind::parameters:
      check_thresholds(read_parameter_file(file));
      return {"calibration"};
    case FileKind::mapping:
      import_log(file);
      return {"import mapping"};
    case FileKind::campaign:
      return {"campaign", check_campaign(file)};
    case FileKind::data_spec:
      return {"data specification", check_data_spec(file)};
    case FileKind::figures:
      check_figures(file);
      return {"figures"};
    case FileKind::robot: {
      const std::string text = read_config_file(file);
      const RobotFile robot = parse_robot_file(text, file.string());
      check_thresholds(robot_calibrations(text, file.string()), robot);
      return {"robot", {}, robot_warnings(robot), robot};
    }
    case FileKind::scenario:
      break;
  }
  const Scenario scenario = check_scenario(file);
  return {"scenario", scenario.warnings, robot_warnings(scenario.robot)};
}

Checked check_file(const std::filesystem::path& file, const CommonOptions& common) {
  if (file.extension() == ".onnx") {
    check_classifier(file);
    return {"classifier"};
  }
  if (file.extension() == ".h5" || is_journal(file)) return {check_results(file, common)};
  return check_text(file);
}

std::vector<std::string> warnings_of(const std::filesystem::path& file, const Checked& checked) {
  std::vector<std::string> warnings;
  for (const std::string& warning : checked.robot_warnings)
    warnings.push_back(file.string() + ": " + warning);
  for (const CalibrationWarning& warning : checked.warnings) warnings.push_back(warning.sentence);
  return warnings;
}

Json checked_json(const std::filesystem::path& file, const Checked& checked) {
  Json json = {{"file", file.string()},
               {"kind", checked.what},
               {"good", true},
               {"warnings", warnings_of(file, checked)}};
  if (checked.robot) json["robot"] = robot_summary_json(*checked.robot);
  return json;
}

void tell(const std::filesystem::path& file, const Checked& checked, const CommonOptions& common) {
  const char* more = "";
  if (checked.what == "readings") more = ", for flinch calibrate";
  if (checked.what == "campaign results") more = ", by what it says it is; its columns were not read";
  if (!common.quiet && !common.json) {
    print_result("{}: a good {} file{}\n", file.string(), checked.what, more);
    if (checked.robot) print_result("{}", robot_summary_text(*checked.robot));
  }
  for (const std::string& warning : warnings_of(file, checked)) print_message("warning: {}\n", warning);
}

void draw_workspace(const std::filesystem::path& file, const Checked& checked, const CheckOptions& options) {
  if (!checked.robot || options.files.size() > 1)
    throw SetupError(file.string() + ": --picture draws the workspace of one robot file; give that alone");
  write_result(options.picture, workspace_picture(*checked.robot));
  if (!options.common.quiet && !options.common.json) print_result("picture: {}\n", options.picture.string());
}

}  // namespace

ExitStatus report(const ReportOptions& options) {
  const std::filesystem::path page =
      options.out.empty() ? options.recording.parent_path() / "report.html" : options.out;
  require_output(page, {options.recording}, OutputKind::page);
  write_report_page(recorded_report(options.recording, options.common), page);
  if (options.common.json) {
    print_result("{}\n", json_text(Json{{"report", page.string()}}));
  } else if (!options.common.quiet) {
    print_result("report: {}\n", page.string());
  }
  return ExitStatus::done;
}

ExitStatus check(const CheckOptions& options) {
  if (!options.picture.empty()) require_output(options.picture, options.files, OutputKind::picture);
  std::vector<std::string> problems;
  Json all = Json::array();
  for (const std::filesystem::path& file : options.files) {
    try {
      const Checked checked = check_file(file, options.common);
      if (options.common.json) all.push_back(checked_json(file, checked));
      tell(file, checked, options.common);
      if (!options.picture.empty()) draw_workspace(file, checked, options);
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(problems);
  if (options.common.json)
    print_result("{}\n", json_text(all.size() == 1 ? all.front() : Json{{"files", all}}));
  return ExitStatus::done;
}

}  // namespace flinch
