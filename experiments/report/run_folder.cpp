#include "experiments/report/run_folder.h"

#include "experiments/report/experiment_report.h"
#include "experiments/report/report_page.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

std::filesystem::path default_folder(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path("out") / name;
  if (!name.empty() && name != "." && name != ".." && folder.filename() == name) return folder;
  throw SetupError("'" + name + "' cannot be the name of a folder for results; choose one with --out");
}

RunFolder make_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": the folder cannot be made: " + error.message());
  return {folder, FolderLock(folder)};
}

std::filesystem::path recording_in(const std::filesystem::path& folder) { return folder / "run.h5"; }

Verdict report_run(const Scenario& scenario, const Recording& recording, const std::filesystem::path& folder,
                   const std::function<void(double share)>& progress) {
  const auto [verdict, report] = judged_report(scenario, recording, progress);
  write_report_page(report, folder / "report.html");
  return verdict;
}

Verdict conclude_run(const Scenario& scenario, const Recording& recording,
                     const std::filesystem::path& folder) {
  write_recording(recording, recording_in(folder));
  return report_run(scenario, open_recording(recording_in(folder)), folder);
}

}  // namespace flinch
