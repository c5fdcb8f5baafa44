#include "experiments/campaign/campaign_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/campaign/campaign.h"
#include "systems/foundation/setup_error.h"
#include "tests/experiments/campaign/small_campaign.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

RunResult result_number(std::size_t number) {
  RunResult result;
  result.run = number;
  result.values = {{"key", "value, " + std::to_string(number)}};
  result.estimators = {
      {.name = number < 2 ? "observer" : "filter", .detection_time = 0.001 * static_cast<double>(number)}};
  return result;
}

class AJournal : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(place / "out");
    campaign = test::small_campaign(place, 5);
  }
  std::filesystem::path folder() const { return place / "out"; }

  test::Workplace place;
  Campaign campaign;
};

TEST_F(AJournal, KeepsWholeRowsWhereverItIsCut) {
  {
    CampaignJournal journal(folder(), campaign);
    for (std::size_t i = 0; i < 4; ++i) journal.add(result_number(i));
  }
  const std::string whole = test::bytes_of(folder() / "results.part");
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    place.write("out/results.part", whole.substr(0, length));
    if (length > 0 && whole.substr(0, length).find('\n') == std::string::npos) continue;  // not even its name
    const CampaignJournal journal(folder(), campaign);
    EXPECT_LE(journal.results().size(), 4U);
    for (const RunResult& result : journal.results())
      EXPECT_EQ(csv_row(result), csv_row(result_number(result.run)));
  }
  EXPECT_EQ(CampaignJournal(folder(), campaign).results().size(), 4U);
}

TEST_F(AJournal, GoesOnBehindATornRow) {
  { CampaignJournal(folder(), campaign).add(result_number(0)); }
  std::ofstream(folder() / "results.part", std::ios::app) << "1,0,0,5,1,\"val";
  { CampaignJournal(folder(), campaign).add(result_number(2)); }
  const CampaignJournal journal(folder(), campaign);
  EXPECT_EQ(journal.done(), 2U);
  EXPECT_TRUE(journal.has(2));
  EXPECT_FALSE(journal.has(1));
}

TEST_F(AJournal, LeavesOutARowThatWasChanged) {
  { CampaignJournal(folder(), campaign).add(result_number(3)); }
  place.replace("out/results.part", "value, 3", "value, 4");
  EXPECT_TRUE(CampaignJournal(folder(), campaign).results().empty());
}

TEST_F(AJournal, TellsItsResultsInTheOrderOfTheirNumbersAndOnceEach) {
  CampaignJournal journal(folder(), campaign);
  for (const std::size_t number : {7U, 2U, 5U, 2U}) journal.add(result_number(number));
  std::vector<std::size_t> numbers;
  for (const RunResult& result : journal.results()) numbers.push_back(result.run);
  EXPECT_THAT(numbers, ::testing::ElementsAre(2U, 5U, 7U));
}

TEST_F(AJournal, OfAnotherCampaignIsRefused) {
  { CampaignJournal(folder(), campaign).add(result_number(0)); }
  campaign.seed = 2;
  const auto before = place.contents();
  try {
    CampaignJournal(folder(), campaign);
    FAIL() << "the seed is another";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.problems().front(), HasSubstr("--fresh"));
    EXPECT_TRUE(place.contents() == before);
  }
}

}  // namespace
}  // namespace flinch
