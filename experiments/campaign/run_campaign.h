#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/run_result.h"

namespace flinch {

class CampaignHelpers;
struct Campaign;
struct CampaignRun;

/// Told now and then how many runs are done, and how many were so before the call. Returns false to stop:
/// what is done is kept.
using CampaignProgress = std::function<bool(std::size_t done, std::size_t done_before)>;

/// Simulates a run and judges it.
RunResult simulate_run(const CampaignRun& run);

/// Does what the campaign asks for at a number: simulates and judges that run, or what its task says.
RunResult do_run(const Campaign& campaign, std::size_t number);

/// Does all runs that `folder` does not hold yet, on `threads` threads (0: one a processor), and returns the
/// results of all in the order of their numbers, the same for any number of threads. Whole tables,
/// results.csv and results.h5, are written once all are done; until then `folder` holds results.part, from
/// which the same call goes on. `helpers` do runs as well; null: there are none. Throws SetupError for a run
/// that cannot be made, with its number and what was drawn for it, and where the first run that `folder`
/// holds comes out otherwise now.
CampaignResults run_campaign(const Campaign& campaign, const std::filesystem::path& folder,
                             std::size_t threads = 0, const CampaignProgress& progress = {},
                             CampaignHelpers* helpers = nullptr);

}  // namespace flinch
