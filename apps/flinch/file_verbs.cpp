// What the verbs do that only look at files.
#include <fmt/core.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/verdict/verdict.h"
#include "systems/config/config_file.h"
#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
#include "systems/config/parameter_file.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"
#include "systems/framework/recording_journal.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Report recorded_report(const std::filesystem::path& file, const CommonOptions& common) {
  const Recording recording = open_recording(file);
  tell_if_partial(recording, common);
  const Scenario scenario = scenario_of(recording, file);
  return out_of(file, [&] {
    return experiment_report(
        scenario, recording,
        judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits));
  });
}

std::string quoted_for_shell(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Lets Graphviz draw `dot` into `file`, which is replaced only by a whole picture.
void draw_svg(const std::string& dot, const std::filesystem::path& file) {
  const ResultFile source(file.string() + ".dot");  // never finished
  source.write(dot);
  ResultFile picture(file);
  const std::string command = "dot -Tsvg -o " + quoted_for_shell(picture.unfinished_name()) + " " +
                              quoted_for_shell(source.unfinished_name());
  if (std::system(command.c_str()) == 0) return picture.finish();
  throw SetupError(file.string() +
                   ": Graphviz could not draw it; is the program 'dot' installed (package graphviz)?");
}

bool is_campaign_file(const std::filesystem::path& file) {
  const ConfigReader reader = ConfigReader::open(file);
  return reader.has("scenarios") || (reader.has("scenario") && !reader.has("csv"));
}

}  // namespace

ExitStatus report(const ReportOptions& options) {
  const std::filesystem::path page =
      options.out.empty() ? options.recording.parent_path() / "report.html" : options.out;
  require_place(page, {options.recording});
  write_report_page(recorded_report(options.recording, options.common), page);
  if (options.common.json) {
    fmt::print("{}\n", json_text(Json{{"report", page.string()}}));
  } else if (!options.common.quiet) {
    fmt::print("report: {}\n", page.string());
  }
  return ExitStatus::done;
}

ExitStatus graph(const GraphOptions& options) {
  const std::string extension = options.out.extension().string();
  if (!options.out.empty() && extension != ".svg" && extension != ".dot") {
    throw SetupError(options.out.string() + ": a graph is written as .svg or .dot, not as '" + extension +
                     "'");
  }
  require_place(options.out, {options.scenario});
  const std::string dot = closed_loop(options.scenario)->graphviz();
  if (options.out.empty()) {
    fmt::print("{}", options.common.json ? json_text(Json{{"dot", dot}}) + "\n" : dot);
    return ExitStatus::done;
  }
  if (extension == ".svg") {
    draw_svg(dot, options.out);
  } else {
    write_result(options.out, dot);
  }
  if (options.common.json) {
    fmt::print("{}\n", json_text(Json{{"graph", options.out.string()}}));
  } else if (!options.common.quiet) {
    fmt::print("graph: {}\n", options.out.string());
  }
  return ExitStatus::done;
}

ExitStatus check(const CheckOptions& options) {
  std::string what;
  if (options.file.extension() == ".h5" || is_journal(options.file)) {
    recorded_report(options.file, options.common);
    what = "recording";
  } else if (kind_of(options.file) == FileKind::parameters) {
    read_parameter_file(options.file);
    what = "calibration";
  } else if (kind_of(options.file) == FileKind::robot) {
    const std::string text = read_config_file(options.file);
    parse_robot_file(text, options.file.string());
    robot_calibrations(text, options.file.string());
    what = "robot";
  } else if (is_campaign_file(options.file)) {
    check_campaign(options.file);
    what = "campaign";
  } else {
    closed_loop(options.file);
    what = "scenario";
  }
  if (options.common.json) {
    fmt::print("{}\n", json_text(Json{{"file", options.file.string()}, {"kind", what}, {"good", true}}));
  } else if (!options.common.quiet) {
    fmt::print("{}: a good {} file\n", options.file.string(), what);
  }
  return ExitStatus::done;
}

}  // namespace flinch
