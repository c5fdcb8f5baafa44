#include "apps/flinch/conclusion.h"

#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "experiments/recorded/judged_log.h"
#include "experiments/recorded/robot_as_drawn.h"
#include "experiments/report/run_folder.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

ExitStatus status_of(const Verdict& verdict) {
  if (verdict.good()) return ExitStatus::done;
  return verdict.fault.empty() ? ExitStatus::bad_verdict : ExitStatus::fault;
}

}  // namespace

RunFolder folder_of(const RunOptions& options, const std::string& name) {
  return make_run_folder(options.out.empty() ? default_folder(name) : options.out);
}

void tell_if_partial(const Recording& recording, const CommonOptions& common) {
  const auto partial = recording.attributes.find("recording.partial");
  if (partial == recording.attributes.end() || common.quiet) return;
  print_message("partial:   {}\n", partial->second);
}

bool is_short(const Recording& recording) { return recording.samples() < 60'000; }

void require_run(const Recording& recording, const std::filesystem::path& file) {
  if (!holds_readings_alone(recording)) return;
  throw SetupError(file.string() +
                   ": holds readings and no run; 'flinch judge' and 'flinch calibrate' can use it");
}

ExitStatus conclude(const Scenario& scenario, double wall, const std::filesystem::path& folder,
                    const CommonOptions& common) {
  const Recording recording = open_recording(recording_in(folder));
  const Verdict verdict = [&] {
    Progress progress("judging " + scenario.name, is_short(recording) || common.quiet || common.json);
    return report_run(scenario, recording, folder, [&progress](double share) { progress.show(share); });
  }();
  const RunFacts facts{wall, scenario.seed, robot_as_drawn(recording)};
  print_result("{}", common.json ? verdict_json(verdict, facts) + "\n" : verdict_table(verdict, facts));
  if (!common.quiet) {
    print_message("recording: {}\nreport:    {}\n", recording_in(folder).string(),
                  (folder / "report.html").string());
  }
  return status_of(verdict);
}

}  // namespace flinch
