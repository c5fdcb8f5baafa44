#include "experiments/campaign/campaign_results.h"

#include <utility>

namespace flinch {

CampaignResults::CampaignResults(std::size_t size, Read read) : size_(size), read_(std::move(read)) {}

CampaignResults::CampaignResults(std::vector<RunResult> results)
    : size_(results.size()), read_([kept = std::move(results)](std::size_t place) { return kept[place]; }) {}

CampaignResults::CampaignResults(std::initializer_list<RunResult> results)
    : CampaignResults(std::vector<RunResult>(results)) {}

}  // namespace flinch
