// What the verbs of the command line do.
#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/experiment.h"
#include "apps/flinch/experiment_report.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/report_page.h"
#include "apps/flinch/scenario.h"
#include "apps/flinch/verdict.h"
#include "apps/flinch/verdict_output.h"
#include "systems/config/config_file.h"
#include "systems/config/config_reader.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": the folder cannot be made: " + error.message());
}

ExitStatus status_of(const Verdict& verdict) {
  if (!verdict.fault.empty()) return ExitStatus::fault;
  return verdict.good() ? ExitStatus::done : ExitStatus::bad_verdict;
}

void print_verdict(const Verdict& verdict, const RunFacts& facts, const CommonOptions& common) {
  const std::string text = common.json ? verdict_json(verdict, facts) + "\n" : verdict_table(verdict, facts);
  fmt::print("{}", text);
}

void write_text(const std::string& text, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw SetupError(file.string() + ": the file cannot be written");
}

/// Lets Graphviz draw `dot` into `file`.
void draw_svg(const std::string& dot, const std::filesystem::path& file) {
  const std::string command = "dot -Tsvg -o '" + file.string() + "'";
  FILE* graphviz = file.string().find('\'') == std::string::npos ? popen(command.c_str(), "w") : nullptr;
  if (graphviz != nullptr) std::fwrite(dot.data(), 1, dot.size(), graphviz);
  if (graphviz == nullptr || pclose(graphviz) != 0) {
    throw SetupError(file.string() +
                     ": Graphviz could not draw it; is the program 'dot' installed (package graphviz)?");
  }
}

}  // namespace

ExitStatus run(const RunOptions& options) {
  const Scenario scenario = read_scenario(options.scenario, options.seed);
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("out") / scenario.name : options.out;
  build_experiment(scenario);  // says what does not fit before anything is written
  make_folder(folder);

  const auto started = std::chrono::steady_clock::now();
  Recording recording;
  {
    Progress progress("simulating " + scenario.name, options.common.quiet || options.common.json);
    recording = run_experiment(scenario, {{"command_line", options.common.command_line}},
                               [&progress](double share) { progress.show(share); });
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;

  const Verdict verdict = judge(recording, scenario.expected, scenario.force_limits);
  write_recording(recording, folder / "run.h5");
  write_report_page(experiment_report(scenario, recording, verdict), folder / "report.html");
  print_verdict(verdict, {wall.count(), scenario.seed}, options.common);
  if (!options.common.quiet) {
    fmt::print(stderr, "recording: {}\nreport:    {}\n", (folder / "run.h5").string(),
               (folder / "report.html").string());
  }
  return status_of(verdict);
}

ExitStatus report(const ReportOptions& options) {
  const Recording recording = read_recording(options.recording);
  const Scenario scenario = recorded_scenario(recording, options.recording);
  const std::filesystem::path page =
      options.out.empty() ? options.recording.parent_path() / "report.html" : options.out;
  const Verdict verdict = judge(recording, scenario.expected, scenario.force_limits);
  write_report_page(experiment_report(scenario, recording, verdict), page);
  if (options.common.json) {
    fmt::print("{}\n", Json{{"report", page.string()}}.dump());
  } else if (!options.common.quiet) {
    fmt::print("report: {}\n", page.string());
  }
  return ExitStatus::done;
}

ExitStatus graph(const GraphOptions& options) {
  const std::string dot = build_experiment(read_scenario(options.scenario)).diagram->graphviz();
  const std::string extension = options.out.extension().string();
  if (options.out.empty()) {
    fmt::print("{}", options.common.json ? Json{{"dot", dot}}.dump() + "\n" : dot);
    return ExitStatus::done;
  }
  if (extension == ".svg") {
    draw_svg(dot, options.out);
  } else if (extension == ".dot") {
    write_text(dot, options.out);
  } else {
    throw SetupError(options.out.string() + ": a graph is written as .svg or .dot, not as '" + extension +
                     "'");
  }
  if (options.common.json) {
    fmt::print("{}\n", Json{{"graph", options.out.string()}}.dump());
  } else if (!options.common.quiet) {
    fmt::print("graph: {}\n", options.out.string());
  }
  return ExitStatus::done;
}

ExitStatus check(const CheckOptions& options) {
  std::string what;
  if (options.file.extension() == ".h5") {
    recorded_scenario(read_recording(options.file), options.file);
    what = "recording";
  } else if (ConfigReader::open(options.file).has("legs")) {
    read_robot_file(options.file);
    what = "robot";
  } else {
    build_experiment(read_scenario(options.file));
    what = "scenario";
  }
  if (options.common.json) {
    fmt::print("{}\n", Json{{"file", options.file.string()}, {"kind", what}, {"good", true}}.dump());
  } else if (!options.common.quiet) {
    fmt::print("{}: a good {} file\n", options.file.string(), what);
  }
  return ExitStatus::done;
}

}  // namespace flinch
