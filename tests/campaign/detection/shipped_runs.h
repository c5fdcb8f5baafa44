#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/run_campaign.h"
#include "tests/support/temporary_folder.h"

namespace flinch::test {

/// A campaign that ships, with so many draws at each point of its grid, and with keys `set` as `--set` does.
inline Campaign shipped(const std::string& name, std::size_t draws,
                        const std::vector<std::string>& set = {}) {
  CampaignOverrides fewer;
  fewer.draws = draws;
  fewer.set = set;
  return read_campaign(std::string(FLINCH_SOURCE_DIR "/apps/campaigns/") + name + ".yaml", fewer);
}

inline std::vector<RunResult> runs_of(const Campaign& campaign) {
  const TemporaryFolder folder;
  const CampaignResults results = run_campaign(campaign, folder.path(), 2);
  return {results.begin(), results.end()};
}

inline std::vector<RunResult> shipped_runs(const std::string& name, std::size_t draws) {
  return runs_of(shipped(name, draws));
}

}  // namespace flinch::test
