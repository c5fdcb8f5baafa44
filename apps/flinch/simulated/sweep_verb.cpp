// flinch run --set KEY=FIRST..LAST:STEP: a run for each of several values.
#include <string>
#include <utility>
#include <vector>

#include "apps/flinch/conclusion.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/shell_word.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "apps/flinch/simulated/told_campaign.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/sweep.h"
#include "experiments/report/run_folder.h"
#include "systems/foundation/result_file.h"

namespace flinch {
namespace {

/// In memory: the journal that they are read from is of no use once all are there.
CampaignResults in_memory(const CampaignResults& results) {
  return std::vector<RunResult>(results.begin(), results.end());
}

std::string with_option(const std::string& name, const std::string& value) {
  return " " + name + " " + shell_word(value);
}

/// What all runs have in common: the call without the values that are varied, and without a place.
std::string common_call(const RunOptions& options) {
  std::string call = "flinch run " + shell_word(options.input.string());
  for (const auto& model : options.classifier) call += with_option("--classifier", model.string());
  for (const std::string& fault : options.faults) call += with_option("--fault", fault);
  if (options.seed) call += with_option("--seed", std::to_string(*options.seed));
  for (const std::string& text : options.set)
    if (!gives_several_values(text)) call += with_option("--set", text);
  return call;
}

RunCall call_of_runs(const RunOptions& options) {
  return [common = common_call(options)](const std::vector<std::pair<std::string, std::string>>& values) {
    std::string call = common;
    for (const auto& [key, value] : values) call += with_option("--set", key + "=" + value);
    return call;
  };
}

}  // namespace

ExitStatus run_sweep(const RunOptions& options) {
  Campaign sweep = read_sweep(options.input, options.set, options.seed);
  sweep.addition = addition_of(options.classifier, options.faults);
  for (const CalibrationWarning& warning : check_campaign(sweep))  // before anything is written
    print_message("warning: {}\n", warning.sentence);
  const RunFolder folder = folder_of(options, sweep.name + "_sweep");
  const StopWatch watch;
  const CampaignResults results = in_memory(
      run_told(sweep, "running " + sweep.name, folder.path, options.threads.value_or(0), options.common)
          .results);
  std::filesystem::remove(folder.path / "results.part");
  if (options.common.json) {
    print_result("{}\n", sweep_json(sweep, results));
  } else {
    print_result("{}\n{} runs in {:.2f} s\n", sweep_table(sweep, results), results.size(), watch.seconds());
  }
  flush_results();  // before what stderr says, where both go into one file
  const std::filesystem::path page = folder.path / "sweep.html";
  write_result(page, sweep_page(sweep, results, call_of_runs(options), options.common.command_line));
  write_result(folder.path / "sweep.json", sweep_json(sweep, results) + "\n");
  if (!options.common.quiet) {
    print_message("results:   {}, sweep.json\nreport:    {}\n", (folder.path / "results.csv").string(),
                  page.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
