#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/campaign_summary.h"

namespace flinch {

class CountedAlarms;
struct Campaign;

/// What a campaign showed, as one HTML page that needs nothing else: how soon contacts were detected, by
/// body, estimator and place in the grid; that over false alarms per hour, of `alarms`; all groups with
/// their exact bounds; the runs to look at. `call`: the command that ran it, for who repeats one.
std::string campaign_page(const Campaign& campaign, const CampaignResults& results,
                          const std::vector<CampaignGroup>& groups, const CountedAlarms& alarms,
                          const std::string& call);

/// Writes it to `file`. Throws SetupError where that fails.
void write_campaign_page(const Campaign& campaign, const CampaignResults& results,
                         const std::vector<CampaignGroup>& groups, const CountedAlarms& alarms,
                         const std::string& call, const std::filesystem::path& file);

}  // namespace flinch
