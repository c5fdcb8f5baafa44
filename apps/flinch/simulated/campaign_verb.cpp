// flinch campaign: many runs, and what they show together.
#include <fmt/core.h>

#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
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
#include "experiments/campaign/run_campaign.h"
#include "experiments/report/run_folder.h"
#include "experiments/simulated/experiment.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/recording.h"
#if FLINCH_HAS_MPI
#include "experiments/ranks/campaign_ranks.h"
#endif

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

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

bool is_above_one(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && std::atoi(value) > 1;
}

/// Whether mpirun or srun has started this program together with others.
bool started_with_others() {
  const bool by_srun = std::getenv("PMIX_RANK") != nullptr && is_above_one("SLURM_STEP_NUM_TASKS");
  return by_srun || is_above_one("OMPI_COMM_WORLD_SIZE") || is_above_one("PMI_SIZE");
}

/// The other programs that work on the campaign; null where this one was started alone.
std::unique_ptr<CampaignHelpers> helpers_of([[maybe_unused]] const Campaign& campaign) {
  if (!started_with_others()) return nullptr;
#if FLINCH_HAS_MPI
  return std::make_unique<CampaignRanks>(campaign);
#else
  throw SetupError(
      "this flinch was built without MPI, so several of them cannot work on one campaign; start it alone, or "
      "build it with -DFLINCH_BUILD_MPI=ON where MPI is installed");
#endif
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
  if (!options.classifier.empty()) {
    const auto follow = classifier_of(options.classifier);
    std::set<std::string> models;  // in whatever order they are given
    for (const auto& model : options.classifier) models.insert(sha256_of(model));
    std::string name = "classifier";
    for (const std::string& model : models) name += " " + model;
    campaign.addition = {name, follow};
  }
  if (options.run) return repeat_run(options, campaign);
  const std::unique_ptr<CampaignHelpers> helpers = helpers_of(campaign);
  if (helpers && !helpers->leads()) {
    helpers->work(campaign);
    return ExitStatus::done;
  }
  for (const CalibrationDoubt& doubt : check_campaign(campaign))  // before anything is written
    print_message("warning: {}\n", doubt.sentence);
  std::optional<CountedAlarms> alarms;
  if (!options.false_alarms.empty()) alarms.emplace(campaign, options.false_alarms);
  const RunFolder folder = campaign_folder(options, campaign);
  const StopWatch watch;
  std::size_t before = campaign.runs();
  std::signal(SIGINT, [](int) { interrupted = 1; });
  const CampaignResults results = [&] {
    Progress progress("campaign " + campaign.name, options.common.quiet || options.common.json);
    const auto show = [&](std::size_t done, std::size_t done_before) {
      before = done_before;
      const auto runs = static_cast<double>(campaign.runs());
      progress.show(static_cast<double>(done) / runs, static_cast<double>(done_before) / runs);
      return interrupted == 0;
    };
    return run_campaign(campaign, folder, options.threads.value_or(helpers ? 1 : 0), show, helpers.get());
  }();
  std::signal(SIGINT, SIG_DFL);
  if (results.size() < campaign.runs()) {
    throw SetupError(fmt::format("stopped after {} of {} runs; the same call goes on from there",
                                 results.size(), campaign.runs()));
  }
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
