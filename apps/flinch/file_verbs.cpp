// What the verbs do that only look at files.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/shell_word.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "calibration/csv_recording.h"
#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/scenario/scenario_calibrations.h"
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

/// Lets Graphviz draw `dot` into `file`, which is replaced only by a whole picture.
void draw_svg(const std::string& dot, const std::filesystem::path& file) {
  const ResultFile source(file.string() + ".dot");  // never finished
  source.write(dot);
  ResultFile picture(file);
  const std::string command =
      "dot -Tsvg -o " + shell_word(picture.unfinished_name()) + " " + shell_word(source.unfinished_name());
  if (std::system(command.c_str()) == 0) return picture.finish();
  throw SetupError(file.string() +
                   ": Graphviz could not draw it; is the program 'dot' installed (package graphviz)?");
}

/// The kind of a good file, and what to know of it.
struct Checked {
  std::string what;
  std::vector<CalibrationDoubt> doubts = {};
};

/// Checks a file of HDF5, and says of which kind it is.
std::string check_results(const CheckOptions& options) {
  const std::string format = hdf5_format(options.file);
  if (format == "flinch campaign") return "campaign results";
  if (format.starts_with("flinch contacts")) {
    check_data_set(options.file);
    return "data set";
  }
  const Recording recording = open_recording(options.file);
  const bool readings = holds_readings_alone(recording);
  if (readings) {
    scenario_of(recording, options.file);
  } else {
    recorded_report(options.file, options.common);
  }
  out_of(options.file, [&] { read_every_row(recording); });  // a page and a verdict read some only
  return readings ? "readings" : "recording";
}

/// The same of YAML.
Checked check_text(const std::filesystem::path& file) {
  switch (kind_of(file).value_or(FileKind::scenario)) {
    case FileKind::parameters:
      check_thresholds(read_parameter_file(file));
      return {"calibration"};
    case FileKind::mapping:
      read_csv_recording(file);
      return {"import mapping"};
    case FileKind::campaign:
      return {"campaign", check_campaign(file)};
    case FileKind::data_spec:
      return {"data specification", check_data_spec(file)};
    case FileKind::robot: {
      const std::string text = read_config_file(file);
      const RobotFile robot = parse_robot_file(text, file.string());
      check_thresholds(robot_calibrations(text, file.string()), robot);
      return {"robot"};
    }
    case FileKind::scenario:
      break;
  }
  return {"scenario", check_scenario(file)};
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

ExitStatus graph(const GraphOptions& options) {
  const std::string extension = options.out.extension().string();
  if (!options.out.empty() && extension != ".svg" && extension != ".dot") {
    throw SetupError(options.out.string() + ": a graph is written as .svg or .dot, not as '" + extension +
                     "'");
  }
  require_output(options.out, {options.scenario},
                 extension == ".svg" ? OutputKind::picture : OutputKind::graph);
  const std::string dot = closed_loop(options.scenario)->graphviz();
  if (options.out.empty()) {
    print_result("{}", options.common.json ? json_text(Json{{"dot", dot}}) + "\n" : dot);
    return ExitStatus::done;
  }
  if (extension == ".svg") {
    draw_svg(dot, options.out);
  } else {
    write_result(options.out, dot);
  }
  if (options.common.json) {
    print_result("{}\n", json_text(Json{{"graph", options.out.string()}}));
  } else if (!options.common.quiet) {
    print_result("graph: {}\n", options.out.string());
  }
  return ExitStatus::done;
}

ExitStatus check(const CheckOptions& options) {
  Checked checked;
  if (options.file.extension() == ".onnx") {
    check_classifier(options.file);
    checked = {"classifier"};
  } else if (options.file.extension() == ".h5" || is_journal(options.file)) {
    checked = {check_results(options)};
  } else {
    checked = check_text(options.file);
  }
  const std::string& what = checked.what;
  std::vector<std::string> warnings;
  for (const CalibrationDoubt& doubt : checked.doubts) warnings.push_back(doubt.sentence);
  if (options.common.json) {
    print_result(
        "{}\n",
        json_text(
            Json{{"file", options.file.string()}, {"kind", what}, {"good", true}, {"warnings", warnings}}));
  } else if (!options.common.quiet) {
    const char* more = "";
    if (what == "readings") more = ", for flinch calibrate";
    if (what == "campaign results") more = ", by what it says it is; its columns were not read";
    print_result("{}: a good {} file{}\n", options.file.string(), what, more);
  }
  for (const std::string& warning : warnings) print_message("warning: {}\n", warning);
  return ExitStatus::done;
}

}  // namespace flinch
