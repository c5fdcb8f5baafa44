// flinch dataset: labelled contacts from simulated runs and recordings.
#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "apps/flinch/conclusion.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/dataset/data_spec.h"
#include "experiments/dataset/make_data_set.h"
#include "experiments/report/run_folder.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

/// Simulated runs, and contacts of recordings that gave samples.
std::size_t runs_of(const DataSpec& spec, const DataSet& data) {
  const std::size_t simulated = spec.parts.empty() ? 0 : spec.runs;
  std::set<int> recorded;
  for (const DataSample& sample : data.samples) {
    if (sample.run >= static_cast<int>(simulated)) recorded.insert(sample.run);
  }
  return simulated + recorded.size();
}

}  // namespace

std::vector<CalibrationWarning> check_data_spec(const std::filesystem::path& spec) {
  return read_data_spec(spec).warnings;
}

ExitStatus dataset(const DatasetOptions& options) {
  const DataSpec spec = read_data_spec(options.spec, {.runs = options.runs, .seed = options.seed});
  for (const CalibrationWarning& warning : spec.warnings) print_message("warning: {}\n", warning.sentence);
  const std::filesystem::path file =
      options.out.empty() ? std::filesystem::path("out") / (options.spec.stem().string() + ".h5")
                          : options.out;
  const RunFolder folder = make_run_folder(file.has_parent_path() ? file.parent_path() : ".");
  std::vector<std::filesystem::path> inputs = {options.spec};
  for (const DataRecording& recording : spec.recordings) {
    inputs.push_back(recording.file);
    if (!recording.scenario.empty()) inputs.push_back(recording.scenario);
  }
  require_output(file, inputs, OutputKind::data_set);
  if (options.fresh) std::filesystem::remove(file.string() + ".part");
  const StopWatch watch;
  DataSet data;
  std::signal(SIGINT, [](int) { interrupted = 1; });
  {
    Progress progress("data set " + spec.file.stem().string(), options.common.quiet || options.common.json);
    std::optional<double> before;  // done by an earlier call
    data = make_data_set(spec, file, options.threads.value_or(0), [&](std::size_t done) {
      const double share = static_cast<double>(done) / static_cast<double>(spec.runs);
      if (!before) before = share;
      progress.show(share, *before);
      return interrupted == 0;
    });
  }
  std::signal(SIGINT, SIG_DFL);
  const std::size_t runs = runs_of(spec, data);
  if (options.common.json) {
    const nlohmann::ordered_json summary = {{"data", file.string()},
                                            {"runs", runs},
                                            {"samples", data.samples.size()},
                                            {"seed", spec.seed},
                                            {"wall_s", watch.seconds()}};
    print_result("{}\n", json_text(summary));
    return ExitStatus::done;
  }
  print_result("{}: {} runs, {} samples, {:.1f} s\n\n{}", spec.title, runs, data.samples.size(),
               watch.seconds(), counts_table(data));
  if (!data.card["left_out"].empty()) print_result("\nruns that were left out\n{}", data.card["left_out"]);
  if (!options.common.quiet) print_message("data:      {}\n", file.string());
  return ExitStatus::done;
}

}  // namespace flinch
