// Campaigns, with the scenarios that they name, and one run of them.
#include "experiments/campaign/campaign.h"

#include "experiments/campaign/campaign_run.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

void read(std::string_view bytes) {
  const Campaign campaign = read_campaign(fuzz_file("campaign.yaml", bytes));
  campaign.identity();
  if (campaign.runs() > 0) draw_run(campaign, campaign.runs() - 1);
}

std::vector<std::string> seeds() { return shipped_files("campaigns", ".yaml"); }

}  // namespace

const FuzzTarget campaign_target{"campaign", read, seeds};

}  // namespace flinch::test
