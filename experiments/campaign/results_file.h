#pragma once

#include <filesystem>

namespace flinch {

class CampaignResults;

/// Writes the table of a campaign to results.csv and results.h5 in `folder`. Throws SetupError when that
/// fails.
void write_results(const CampaignResults& results, const std::filesystem::path& folder);

}  // namespace flinch
