#include "experiments/campaign/counted_alarms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/results_file.h"
#include "experiments/campaign/run_result.h"
#include "tests/experiments/campaign/small_campaign.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string gains = "control.momentum_observer.gain_per_s";

/// Half an hour of motion without contact.
RunResult half_an_hour(const std::string& gain, bool alarm) {
  RunResult result;
  result.values = {{gains, gain}, {"motion.seed", "7"}};
  result.estimators = {{.name = "followed", .contact_free = 1800.0},
                       {.name = "filter", .false_alarm = alarm, .contact_free = 1800.0}};
  return result;
}

class FalseAlarmsOfAnotherCampaign : public ::testing::Test {
 protected:
  std::filesystem::path table(const CampaignResults& results) const {
    write_results(results, place / ".");
    return place / "results.csv";
  }

  test::Workplace place;
  Campaign campaign = test::small_campaign(place);  // gains of 20 and 40
};

TEST_F(FalseAlarmsOfAnotherCampaign, AreThoseAtTheSamePlaceOfTheGridByTheSameEstimator) {
  const CountedAlarms alarms(campaign,
                             table({half_an_hour("[20, 20, 20]", true), half_an_hour("[40, 40, 40]", false),
                                    half_an_hour("[20, 20, 20]", true)}));
  CampaignGroup group;
  group.at = {{"scenario", "whatever"}, {gains, "[20, 20, 20]"}};
  group.estimator = "filter";
  group.false_alarms = 9;  // its own do not count
  EXPECT_EQ(alarms.of(group).count, 2U);
  EXPECT_NEAR(alarms.of(group).hours, 1.0, 1e-12);
  EXPECT_NEAR(alarms.of(group).rate(), 2.0, 1e-12);
  group.at.back().second = "[40, 40, 40]";
  EXPECT_EQ(alarms.of(group).count, 0U);
  EXPECT_NEAR(alarms.of(group).hours, 0.5, 1e-12);
  group.estimator = "nobody";
  EXPECT_EQ(alarms.of(group).hours, 0.0);
}

TEST_F(FalseAlarmsOfAnotherCampaign, MustCoverTheGrid) {
  const auto file = table({half_an_hour("[20, 20, 20]", true)});
  const auto problems = test::problems_of([&] { CountedAlarms(campaign, file); });
  EXPECT_THAT(problems, ElementsAre(HasSubstr("has no run with value 2 of '" + gains + "'")));
  Campaign other = campaign;
  other.grid[0].key = "control.other";
  EXPECT_THAT(test::problems_of([&] { CountedAlarms(other, file); }),
              ElementsAre(HasSubstr("has no column 'control.other'")));
}

TEST_F(FalseAlarmsOfAnotherCampaign, AreRefusedFromWhatIsNoTable) {
  EXPECT_FALSE(test::problems_of([&] { CountedAlarms(campaign, place / "nowhere.csv"); }).empty());
  place.write("text.csv", "a,b\n1,2\n");
  EXPECT_THAT(test::problems_of([&] { CountedAlarms(campaign, place / "text.csv"); }),
              ::testing::Contains(HasSubstr("no results.csv of flinch campaign")));
  const std::string header = gains + ",filter.false_alarm,filter.contact_free_s\n";
  for (const std::string row :
       {"a,0", "a,0,nan", "a,0,inf", "a,0,-1", "a,0,text", "a,0,1\"", "a,0,1,2", "a,2,1", "a,,1", "a,0,1x"}) {
    place.write("bad.csv", header + row + "\n");
    EXPECT_THAT(test::problems_of([&] { CountedAlarms(campaign, place / "bad.csv"); }),
                ElementsAre(HasSubstr("bad.csv:2: is no row")))
        << row;
  }
}

TEST(FalseAlarmsOfACampaign, AreThoseOfAllScenariosAndBodies) {
  CampaignGroup first, second;
  first.at = {{"scenario", "a"}, {"gain", "20"}};
  first.estimator = second.estimator = "filter";
  first.false_alarms = 1;
  first.contact_free = second.contact_free = 1800.0;
  second.at = {{"scenario", "b"}, {"gain", "20"}};
  second.false_alarms = 2;
  second.body = "link1";
  const CountedAlarms alarms({first, second});
  EXPECT_EQ(alarms.of(first).count, 3U);
  EXPECT_NEAR(alarms.of(second).rate(), 3.0, 1e-12);
  EXPECT_TRUE(alarms.table().empty());
}

}  // namespace
}  // namespace flinch
