// flinch import: a recording out of a log of another tool.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "import/import_summary.h"
#include "import/imported_recording.h"
#include "import/mapping_guess.h"
#include "import/mapping_text.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

std::string summary_json(const ImportSummary& summary, const std::filesystem::path& out) {
  Json signals = Json::object();
  for (const SignalSummary& signal : summary.signals) {
    Json columns = Json::array(), least = Json::array(), most = Json::array();
    for (const SignalSummary::Entry& entry : signal.entries) {
      columns.push_back(entry.column);
      least.push_back(entry.least);
      most.push_back(entry.most);
    }
    signals[signal.name] = {
        {"columns", columns}, {"valid_fraction", signal.valid_fraction}, {"least", least}, {"most", most}};
  }
  return json_text(Json{{"recording", out.string()},
                        {"samples", summary.samples},
                        {"rows", summary.rows},
                        {"rate_Hz", summary.rate},
                        {"jitter_ms", 1e3 * summary.jitter},
                        {"gaps", summary.gaps},
                        {"repeated", summary.repeated},
                        {"signals", signals},
                        {"unused_columns", summary.unused},
                        {"warnings", summary.warnings}});
}

void print_summary(const ImportSummary& summary, const std::filesystem::path& out) {
  print_result("log:       {} rows at {:.1f} Hz, jitter {:.3f} ms, {} gaps, {} repeated\n", summary.rows,
               summary.rate, 1e3 * summary.jitter, summary.gaps, summary.repeated);
  for (const SignalSummary& signal : summary.signals) {
    for (const SignalSummary::Entry& entry : signal.entries)
      print_result("{:<30} {:>10.4g} ... {:<10.4g} from '{}'\n",
                   fmt::format("  {}[{}]", signal.name, entry.entry), entry.least, entry.most, entry.column);
    print_result("  {} is valid in {:.1f} % of the samples\n", signal.name, 100.0 * signal.valid_fraction);
  }
  if (!summary.unused.empty()) {
    const std::size_t shown = std::min<std::size_t>(summary.unused.size(), 20);
    std::string list;
    for (std::size_t i = 0; i < shown; ++i) list += (i > 0 ? ", " : "") + summary.unused[i];
    print_result("unused:    {}{}\n", list, shown < summary.unused.size() ? ", ..." : "");
  }
  if (!out.empty()) print_result("recording: {}, {:.1f} s\n", out.string(), summary.seconds);
}

LogMapping wanted_mapping(const ImportOptions& options, std::vector<std::string>& questions) {
  if (!options.guess) {
    if (!options.robot.empty()) throw SetupError("--robot: is for --guess; a mapping names its robot");
    return read_log_mapping(options.mapping);
  }
  if (options.robot.empty()) throw SetupError("--guess: needs --robot, of which the log is");
  MappingGuess guess = guess_mapping(options.mapping, options.robot);
  if (!options.common.json && !options.common.quiet) print_result("{}", mapping_text(guess, options.robot));
  questions = guess.questions;
  return guess.mapping;
}

}  // namespace

ExitStatus import_log(const ImportOptions& options) {
  if (options.out.empty() && !options.guess)
    throw SetupError("--out: names the recording that is written; without it only --guess says something");
  std::vector<std::string> questions;
  const LogMapping mapping = wanted_mapping(options, questions);
  if (!options.out.empty()) require_output(options.out, files_of(mapping), OutputKind::recording);
  const auto log = std::make_shared<const MappedLog>(mapping);
  ImportSummary summary = summary_of(*log);
  for (const std::string& question : questions) summary.warnings.push_back(question);
  if (!options.out.empty())
    write_recording(imported_recording(log, {{"command_line", options.common.command_line}}), options.out);
  if (options.common.json) {
    print_result("{}\n", summary_json(summary, options.out));
    return ExitStatus::done;
  }
  for (const std::string& warning : summary.warnings) print_message("warning: {}\n", warning);
  if (!options.common.quiet) print_summary(summary, options.out);
  return ExitStatus::done;
}

}  // namespace flinch
