#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/run_campaign.h"

namespace flinch::test {

/// A campaign that ships, with so many draws at each point of its grid.
inline Campaign shipped(const std::string& name, std::size_t draws) {
  CampaignOverrides fewer;
  fewer.draws = draws;
  return read_campaign(std::string(FLINCH_SOURCE_DIR "/apps/campaigns/") + name + ".yaml", fewer);
}

inline std::vector<RunResult> runs_of(const Campaign& campaign) {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / (std::string(test.test_suite_name()) + "." + test.name());
  std::filesystem::create_directories(folder);
  const std::vector<RunResult> results = run_campaign(campaign, folder, 2);
  std::filesystem::remove_all(folder);
  return results;
}

inline std::vector<RunResult> shipped_runs(const std::string& name, std::size_t draws) {
  return runs_of(shipped(name, draws));
}

}  // namespace flinch::test
