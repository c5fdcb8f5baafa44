#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/run_campaign.h"

namespace flinch::test {

/// So many draws of a campaign that ships, at each point of its grid.
inline std::vector<RunResult> shipped_runs(const std::string& name, std::size_t draws) {
  CampaignOverrides fewer;
  fewer.draws = draws;
  const Campaign campaign =
      read_campaign(std::string(FLINCH_SOURCE_DIR "/apps/campaigns/") + name + ".yaml", fewer);
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::create_directories(folder);
  const std::vector<RunResult> results = run_campaign(campaign, folder, 2);
  std::filesystem::remove_all(folder);
  return results;
}

}  // namespace flinch::test
