#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flinch/command_line.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_helpers.h"
#include "experiments/campaign/campaign_results.h"

namespace flinch {

/// What --classifier and --fault add to each run; none where nothing is asked for. Throws SetupError for a
/// model that is none.
std::optional<CampaignAddition> addition_of(const std::vector<std::filesystem::path>& classifier,
                                            const std::vector<std::string>& faults);

/// The other programs that work on the campaign; null where this one was started alone. Throws SetupError
/// where this program cannot work with others.
std::unique_ptr<CampaignHelpers> helpers_of(const Campaign& campaign);

/// The results of a campaign that was run, and how many of them were there before.
struct ToldCampaign {
  CampaignResults results;
  std::size_t before = 0;
};

/// run_campaign() with a display of how far it is. Ctrl-C ends it, and what is done is kept. Throws
/// SetupError as that does, and where it was ended so.
ToldCampaign run_told(const Campaign& campaign, const std::string& what, const std::filesystem::path& folder,
                      std::size_t threads, const CommonOptions& common, CampaignHelpers* helpers = nullptr);

}  // namespace flinch
