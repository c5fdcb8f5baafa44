// The verbs that only look at files, and their options.
#include <algorithm>
#include <string>
#include <vector>

#include "apps/flinch/verbs.h"
#include "systems/foundation/nearest_name.h"

namespace flinch {
namespace {

/// What is wrong with `text` as a format of exports; "" if nothing is.
std::string problem_with_format(const std::string& text) {
  const std::vector<std::string> names = {"csv", "mat", "mcap", "mjcf", "npz", "urdf"};
  if (std::find(names.begin(), names.end(), text) != names.end()) return "";
  return "is '" + text + "', which is no format" + did_you_mean(text, names);
}

/// Puts the number of the alignment that `text` names in its place; what is wrong with it, "" if nothing is.
std::string number_of_alignment(std::string& text) {
  const std::vector<std::string> names = {"time", "contact", "correlation"};  // as CompareOptions::Align
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end())
    return "is '" + text + "', by which nothing is aligned" + did_you_mean(text, names);
  text = std::to_string(found - names.begin());
  return "";
}

void add_report_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& report_verb = verbs.add(app, "report", "Make the report page of a recording",
                                    "flinch report out/demo/run.h5", verbs.report, &report);
  report_verb.add_option("recording", verbs.report.recording, "Recording (HDF5) of flinch run")
      ->required()
      ->type_name("RUN.h5");
  report_verb.add_option("-o,--out", verbs.report.out, "The page [report.html beside the recording]")
      ->type_name("PAGE.html");
}

void add_export_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& export_verb = verbs.add(
      app, "export", "Write a recording for other tools, of a run or an imported log alike, or a robot",
      "flinch export out/demo/run.h5 --to csv --out out/demo/csv", verbs.export_recording, &export_recording);
  export_verb
      .add_option("recording", verbs.export_recording.recording, "Recording (HDF5), or robot file (YAML)")
      ->required()
      ->type_name("RUN.h5|ROBOT.yaml");
  export_verb
      .add_option("--to", verbs.export_recording.format,
                  "csv (a folder with a table of each signal), mat (MATLAB, Octave), mcap (PlotJuggler, "
                  "Foxglove; JSON), npz (NumPy); of a robot file mjcf (MuJoCo) or urdf (RViz; with a YAML "
                  "file of what closes its loops)")
      ->required()
      ->check(CLI::Validator(problem_with_format, ""))
      ->type_name("FORMAT");
  export_verb
      .add_option("-o,--out", verbs.export_recording.out,
                  "The file or folder [beside what is read: run.npz, run_csv, robot.xml]")
      ->type_name("PLACE");
  export_verb.add_option("--signal", verbs.export_recording.signals, "Only this signal; any number of them")
      ->allow_extra_args(false)
      ->type_name("NAME");
}

void add_compare_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& compare_verb = verbs.add(
      app, "compare", "Show recordings side by side: where they part, settings, verdicts, signals",
      "flinch compare out/demo/run.h5 out/sensitive/run.h5 --align contact", verbs.compare, &compare);
  compare_verb
      .add_option(
          "recordings", verbs.compare.recordings,
          "Two recordings (HDF5) or more, of runs or imported; the first is what others are compared with")
      ->required()
      ->type_name("RUN.h5");
  compare_verb
      .add_option(
          "--align", verbs.compare.align,
          "What the page draws at one place: time, contact (the begin of the first), correlation (of the "
          "motion of the drives) [time]")
      ->transform(CLI::Validator(number_of_alignment, ""))
      ->type_name("BY");
  compare_verb.add_option("-o,--out", verbs.compare.out, "The page [comparison.html]")
      ->type_name("PAGE.html");
}

void add_graph_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& graph_verb =
      verbs.add(app, "graph", "Draw the diagram of a scenario's closed loop",
                "flinch graph apps/scenarios/platform_collision.yaml --out loop.html", verbs.graph, &graph);
  graph_verb
      .add_option("scenario", verbs.graph.scenario,
                  "Scenario file (YAML), or the name of one that comes with flinch")
      ->required()
      ->transform(shipped("scenarios"))
      ->type_name("SCENARIO.yaml");
  graph_verb
      .add_option("-o,--out", verbs.graph.out,
                  "A page (.html) to search and fold, a picture (.svg) or a .dot file [DOT on stdout]")
      ->type_name("FILE");
}

void add_check_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& check_verb = verbs.add(app, "check", "Say all that is wrong with files that flinch reads",
                                   "flinch check apps/robots/planar_3rrr.yaml", verbs.check, &check);
  check_verb
      .add_option(
          "file", verbs.check.files,
          "Any files in YAML, HDF5 or ONNX: scenario, robot, campaign, recording, data set, classifier, ...")
      ->required()
      ->type_name("FILE");
  check_verb
      .add_option("--picture", verbs.check.picture,
                  "Draw the workspace of the one robot file into a .svg file [none]")
      ->type_name("FILE");
}

}  // namespace

void add_file_verbs(CLI::App& app, Verbs& verbs) {
  add_report_verb(app, verbs);
  add_export_verb(app, verbs);
  add_compare_verb(app, verbs);
  add_graph_verb(app, verbs);
  add_check_verb(app, verbs);
}

}  // namespace flinch
