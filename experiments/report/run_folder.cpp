#include "experiments/report/run_folder.h"

#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

void make_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": the folder cannot be made: " + error.message());
}

Verdict conclude_run(const Scenario& scenario, const Recording& recording,
                     const std::filesystem::path& folder) {
  write_recording(recording, folder / "run.h5");
  Verdict verdict = judge(recording, scenario.expected, scenario.force_limits);
  write_report_page(experiment_report(scenario, recording, verdict), folder / "report.html");
  return verdict;
}

}  // namespace flinch
