// flinch campaign: many runs, and what they show together.
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/simulated/told_campaign.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_helpers.h"
#include "experiments/campaign/campaign_journal.h"
#include "experiments/campaign/campaign_page.h"
#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/counted_alarms.h"
#include "experiments/campaign/reaction_summary.h"
#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

/// One run of the table alone, with recording and page.
ExitStatus repeat_run(const CampaignOptions& options, const Campaign& campaign) {
  if (*options.run >= campaign.runs()) {
    throw SetupError(
        fmt::format("--run {}: the campaign has the runs 0 to {}", *options.run, campaign.runs() - 1));
  }
  const std::filesystem::path of_table = options.out.empty() ? default_folder(campaign.name) : options.out;
  require_no_other_results(of_table, campaign);  // its run of this number would be another
  const CampaignRun run = draw_run(campaign, *options.run);
  const RunFolder folder =
      make_run_folder(options.out.empty() ? of_table / fmt::format("run_{}", run.number) : options.out);
  const StopWatch watch;
  record_experiment(run.scenario, recording_in(folder), {{"command_line", options.common.command_line}});
  return conclude(run.scenario, watch.seconds(), folder, options.common);
}

RunFolder campaign_folder(const CampaignOptions& options, const Campaign& campaign) {
  RunFolder folder = make_run_folder(options.out.empty() ? default_folder(campaign.name) : options.out);
  if (options.fresh) std::filesystem::remove(folder.path / "results.part");
  return folder;
}

void print(const Campaign& campaign, const CampaignResults& results, const std::vector<CampaignGroup>& groups,
           const CampaignPace& pace, bool json) {
  if (campaign.summary == Campaign::Summary::reactions) {
    const ReactionSummary summary = reactions_of(results, campaign.missed_after);
    print_result("{}",
                 json ? reactions_json(campaign, summary, pace) + "\n" : reactions_table(campaign, summary));
  } else {
    print_result("{}", json ? campaign_json(campaign, results, groups, pace) + "\n"
                            : campaign_table(campaign, groups, pace));
  }
}

}  // namespace

ExitStatus campaign(const CampaignOptions& options) {
  Campaign campaign =
      read_campaign(options.file, {.set = options.set, .draws = options.runs, .seed = options.seed});
  campaign.addition = addition_of(options.classifier, {});
  if (options.run) return repeat_run(options, campaign);
  const std::unique_ptr<CampaignHelpers> helpers = helpers_of(campaign);
  if (helpers && !helpers->leads()) {
    helpers->work(campaign);
    return ExitStatus::done;
  }
  for (const CalibrationWarning& warning : check_campaign(campaign))  // before anything is written
    print_message("warning: {}\n", warning.sentence);
  std::optional<CountedAlarms> alarms;
  if (!options.false_alarms.empty()) alarms.emplace(campaign, options.false_alarms);
  const RunFolder folder = campaign_folder(options, campaign);
  const StopWatch watch;
  const auto [results, before] =
      run_told(campaign, "campaign " + campaign.name, folder.path, options.threads.value_or(helpers ? 1 : 0),
               options.common, helpers.get());
  const CampaignPace pace{results.size() - before, watch.seconds()};
  const std::vector<CampaignGroup> groups = groups_of(campaign, results);
  print(campaign, results, groups, pace, options.common.json);
  flush_results();  // before what stderr says, where both go into one file
  const std::filesystem::path page = folder.path / "campaign.html";
  write_campaign_page(campaign, results, groups, alarms.value_or(CountedAlarms(groups)),
                      options.common.command_line, page);
  if (!options.common.quiet) {
    print_message("results:   {}\nreport:    {}\n", (folder.path / "results.csv").string(), page.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
