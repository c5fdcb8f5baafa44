// flinch import: a recording out of a log of another tool.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "experiments/comparison/comparison_page.h"
#include "import/import_summary.h"
#include "import/imported_recording.h"
#include "import/mapping_guess.h"
#include "import/mapping_text.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Json computed_json(const std::vector<ComputedColumn>& computed) {
  static constexpr std::array words = {"function", "multiple", "rate"};
  Json columns = Json::object();
  for (const ComputedColumn& column : computed)
    columns[column.name] = {{"is", words[static_cast<std::size_t>(column.how)]}, {"of", column.from}};
  return columns;
}

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
                        {"computed_columns", computed_json(summary.computed)},
                        {"warnings", summary.warnings}});
}

/// A line for all that follow from the same columns in the same way.
void print_computed(const std::vector<ComputedColumn>& computed) {
  std::map<std::string, std::string> by_words;
  for (const ComputedColumn& column : computed) {
    std::string& names = by_words[column.words()];
    names += (names.empty() ? "" : ", ") + column.name;
  }
  for (const auto& [words, names] : by_words)
    print_result("computed:  {}: {}; it tells nothing more\n", names, words);
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
  print_computed(summary.computed);
  if (!out.empty()) print_result("recording: {}, {:.1f} s\n", out.string(), summary.seconds);
}

/// A line of numbers, then what is doubtful, unused and computed.
std::vector<std::string> notes_of(const ImportSummary& summary) {
  std::vector<std::string> notes = summary.warnings;
  for (const SignalSummary& signal : summary.signals) {
    std::string columns;
    for (const SignalSummary::Entry& entry : signal.entries)
      columns += fmt::format("{}{} ({:.4g} to {:.4g})", columns.empty() ? "" : ", ", entry.column,
                             entry.least, entry.most);
    notes.push_back(
        fmt::format("{}, valid in {:.1f} %: {}", signal.name, 100.0 * signal.valid_fraction, columns));
  }
  for (const ComputedColumn& column : summary.computed)
    notes.push_back(fmt::format("{} is {}: it was computed and is no sensor", column.name, column.words()));
  if (!summary.unused.empty()) notes.push_back(fmt::format("unused: {}", fmt::join(summary.unused, ", ")));
  return notes;
}

void write_page(const ImportOptions& options, const ImportSummary& summary, const Recording& recording) {
  const std::string told =
      fmt::format("{} rows in {:.1f} s at {:.1f} Hz, jitter {:.3f} ms, {} gaps, {} repeated", summary.rows,
                  summary.seconds, summary.rate, 1e3 * summary.jitter, summary.gaps, summary.repeated);
  write_result(options.page,
               comparison_page({{options.mapping.filename().string(), &recording, 0.0, {}, false}},
                               {"time", told, {}, options.common.command_line, notes_of(summary)}));
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
  if (options.out.empty() && options.page.empty() && !options.guess)
    throw SetupError("--out: names the recording that is written; without it only --guess says something");
  std::vector<std::string> questions;
  const LogMapping mapping = wanted_mapping(options, questions);
  if (!options.out.empty()) require_output(options.out, files_of(mapping), OutputKind::recording);
  if (!options.page.empty()) require_output(options.page, files_of(mapping), OutputKind::page);
  const auto log = std::make_shared<const MappedLog>(mapping);
  ImportSummary summary = summary_of(*log);
  for (const std::string& question : questions) summary.warnings.push_back(question);
  const Recording recording = imported_recording(log, {{"command_line", options.common.command_line}});
  if (!options.out.empty()) write_recording(recording, options.out);
  if (!options.page.empty()) write_page(options, summary, recording);
  if (options.common.json) {
    print_result("{}\n", summary_json(summary, options.out));
    return ExitStatus::done;
  }
  for (const std::string& warning : summary.warnings) print_message("warning: {}\n", warning);
  if (options.common.quiet) return ExitStatus::done;
  print_summary(summary, options.out);
  if (!options.page.empty()) print_message("page:      {}\n", options.page.string());
  return ExitStatus::done;
}

}  // namespace flinch
