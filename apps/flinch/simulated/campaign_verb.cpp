// flinch campaign: many runs, and what they show together.
#include <fmt/core.h>

#include <csignal>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_page.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

/// One run of the table alone, with recording and page.
ExitStatus repeat_run(const CampaignOptions& options, const Campaign& campaign) {
  if (*options.run >= campaign.runs()) {
    throw SetupError(
        fmt::format("--run {}: the campaign has the runs 0 to {}", *options.run, campaign.runs() - 1));
  }
  const CampaignRun run = draw_run(campaign, *options.run);
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("out") / campaign.name / fmt::format("run_{}", run.number)
                          : options.out;
  make_run_folder(folder);
  const StopWatch watch;
  record_experiment(run.scenario, recording_in(folder), {{"command_line", options.common.command_line}});
  return conclude(run.scenario, watch.seconds(), folder, options.common);
}

std::filesystem::path campaign_folder(const CampaignOptions& options, const Campaign& campaign) {
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path("out") / campaign.name : options.out;
  make_run_folder(folder);
  if (options.fresh) std::filesystem::remove(folder / "results.part");
  return folder;
}

}  // namespace

ExitStatus campaign(const CampaignOptions& options) {
  const Campaign campaign =
      read_campaign(options.file, {.set = options.set, .draws = options.runs, .seed = options.seed});
  if (options.run) return repeat_run(options, campaign);
  draw_run(campaign, 0);  // before anything is written
  const std::filesystem::path folder = campaign_folder(options, campaign);
  const StopWatch watch;
  std::vector<RunResult> results;
  std::size_t before = campaign.runs();
  std::signal(SIGINT, [](int) { interrupted = 1; });
  {
    Progress progress("campaign " + campaign.name, options.common.quiet || options.common.json);
    results = run_campaign(campaign, folder, options.threads.value_or(0),
                           [&](std::size_t done, std::size_t done_before) {
                             before = done_before;
                             progress.show(static_cast<double>(done) / static_cast<double>(campaign.runs()));
                             return interrupted == 0;
                           });
  }
  std::signal(SIGINT, SIG_DFL);
  if (results.size() < campaign.runs()) {
    throw SetupError(fmt::format("stopped after {} of {} runs; the same call goes on from there",
                                 results.size(), campaign.runs()));
  }
  const CampaignPace pace{results.size() - before, watch.seconds()};
  const std::vector<CampaignGroup> groups = groups_of(campaign, results);
  fmt::print("{}", options.common.json ? campaign_json(campaign, groups, pace) + "\n"
                                       : campaign_table(campaign, groups, pace));
  const std::filesystem::path page = folder / "campaign.html";
  write_campaign_page(campaign, results, groups, options.common.command_line, page);
  if (!options.common.quiet) {
    fmt::print(stderr, "results:   {}\nreport:    {}\n", (folder / "results.csv").string(), page.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
