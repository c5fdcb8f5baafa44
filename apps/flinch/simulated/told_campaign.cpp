#include "apps/flinch/simulated/told_campaign.h"

#include <fmt/core.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <set>
#include <utility>

#include "apps/flinch/fault_options.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/progress.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"
#if FLINCH_HAS_MPI
#include "experiments/ranks/campaign_ranks.h"
#endif

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

bool is_above_one(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && std::atoi(value) > 1;
}

/// Whether mpirun or srun has started this program together with others.
bool started_with_others() {
  const bool by_srun = std::getenv("PMIX_RANK") != nullptr && is_above_one("SLURM_STEP_NUM_TASKS");
  return by_srun || is_above_one("OMPI_COMM_WORLD_SIZE") || is_above_one("PMI_SIZE");
}

}  // namespace

std::optional<CampaignAddition> addition_of(const std::vector<std::filesystem::path>& classifier,
                                            const std::vector<std::string>& faults) {
  if (classifier.empty() && faults.empty()) return std::nullopt;
  std::string identity;
  std::function<void(Scenario&)> follow;
  if (!classifier.empty()) {
    follow = classifier_of(classifier);
    std::set<std::string> models;  // in whatever order they are given
    for (const auto& model : classifier) models.insert(sha256_of(model));
    identity = "classifier";
    for (const std::string& model : models) identity += " " + model;
  }
  for (const std::string& fault : faults) identity += (identity.empty() ? "fault " : "\nfault ") + fault;
  return CampaignAddition{identity, [follow, faults](SimulatedScenario& scenario) {
                            if (follow) follow(scenario);
                            add_faults(faults, *scenario.robot.robot, scenario.station.faults);
                          }};
}

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

ToldCampaign run_told(const Campaign& campaign, const std::string& what, const std::filesystem::path& folder,
                      std::size_t threads, const CommonOptions& common, CampaignHelpers* helpers) {
  std::size_t before = campaign.runs();
  std::signal(SIGINT, [](int) { interrupted = 1; });
  CampaignResults results = [&] {
    Progress progress(what, common.quiet || common.json);
    const auto show = [&](std::size_t done, std::size_t done_before) {
      before = done_before;
      const auto runs = static_cast<double>(campaign.runs());
      progress.show(static_cast<double>(done) / runs, static_cast<double>(done_before) / runs);
      return interrupted == 0;
    };
    return run_campaign(campaign, folder, threads, show, helpers);
  }();
  std::signal(SIGINT, SIG_DFL);
  if (results.size() < campaign.runs()) {
    throw SetupError(fmt::format("stopped after {} of {} runs; the same call goes on from there",
                                 results.size(), campaign.runs()));
  }
  return {std::move(results), before};
}

}  // namespace flinch
