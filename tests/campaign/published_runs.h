#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/reaction_summary.h"
#include "experiments/campaign/run_campaign.h"
#include "experiments/campaign/run_result.h"
#include "tests/support/temporary_folder.h"

/// The 72 experiments of [SafePR] V-G, as shipped campaigns repeat them.
namespace flinch::test {

/// What the shipped campaign of this name brings about.
inline std::vector<RunResult> published_runs(const char* name) {
  const Campaign campaign = read_campaign(std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/campaigns" / name);
  const TemporaryFolder folder;
  const CampaignResults results = run_campaign(campaign, folder.path(), 2);
  return {results.begin(), results.end()};
}

inline std::string name_of(const RunResult& run) {
  return level_of(run.law) + ", " + body_of(run) + ", " + std::to_string(run.speed.value_or(0.0)) + " m/s";
}

}  // namespace flinch::test
