#include "apps/flinch/run_folder.h"

#include <fmt/core.h>

#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

ExitStatus status_of(const Verdict& verdict) {
  if (!verdict.fault.empty()) return ExitStatus::fault;
  return verdict.good() ? ExitStatus::done : ExitStatus::bad_verdict;
}

}  // namespace

std::filesystem::path make_run_folder(const RunOptions& options, const std::string& name) {
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("out") / name : options.out;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": the folder cannot be made: " + error.message());
  return folder;
}

ExitStatus conclude_run(const Scenario& scenario, const Recording& recording, double wall,
                        const std::filesystem::path& folder, const CommonOptions& common) {
  write_recording(recording, folder / "run.h5");
  const Verdict verdict = judge(recording, scenario.expected, scenario.force_limits);
  write_report_page(experiment_report(scenario, recording, verdict), folder / "report.html");
  const RunFacts facts{wall, scenario.seed};
  fmt::print("{}", common.json ? verdict_json(verdict, facts) + "\n" : verdict_table(verdict, facts));
  if (!common.quiet) {
    fmt::print(stderr, "recording: {}\nreport:    {}\n", (folder / "run.h5").string(),
               (folder / "report.html").string());
  }
  return status_of(verdict);
}

}  // namespace flinch
