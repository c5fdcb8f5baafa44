#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// The block of docs/files.md that is marked as YAML and begins below "## Campaign file".
std::string documented_campaign() {
  std::ifstream file(FLINCH_SOURCE_DIR "/docs/files.md");
  const std::string document((std::istreambuf_iterator<char>(file)), {});
  const std::string mark = "```yaml\n";
  const std::size_t begin = document.find(mark, document.find("## Campaign file")) + mark.size();
  return document.substr(begin, document.find("```\n", begin) - begin);
}

TEST(DocumentedCampaign, CanBeDrawnAtEveryPointOfItsGrid) {
  const test::Workplace place;
  place.write("campaigns/documented.yaml", documented_campaign());
  const Campaign campaign = read_campaign(place / "campaigns/documented.yaml");
  EXPECT_EQ(campaign.grid_points(), 8U);
  for (std::size_t point = 0; point < campaign.grid_points(); ++point)
    EXPECT_NO_THROW(draw_run(campaign, point * campaign.draws)) << point;
}

TEST(ShippedCampaigns, CanBeDrawn) {
  int campaigns = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FLINCH_SOURCE_DIR "/apps/campaigns")) {
    if (entry.path().extension() != ".yaml") continue;
    const Campaign campaign = read_campaign(entry.path());
    for (std::size_t point = 0; point < campaign.grid_points(); ++point)
      EXPECT_NO_THROW(draw_run(campaign, point * campaign.draws)) << entry.path() << " " << point;
    ++campaigns;
  }
  EXPECT_GT(campaigns, 0);
}

}  // namespace
}  // namespace flinch
