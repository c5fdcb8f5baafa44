#include "experiments/campaign/campaign_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/campaign/campaign.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

Campaign without_grid(std::size_t draws) {
  Campaign campaign;
  campaign.name = "some";
  campaign.title = "Some contacts";
  campaign.draws = draws;
  campaign.scenarios = {"a.yaml"};
  return campaign;
}

RunResult contact(std::optional<double> detection_time, const std::string& body = "platform") {
  RunResult result;
  result.body = body;
  result.estimators = {{.name = "observer", .detection_time = detection_time, .contact_free = 3.6}};
  return result;
}

TEST(AGroup, CountsWhatIsMissedAsLaterThanEverythingElse) {
  std::vector<RunResult> results;
  for (int i = 1; i <= 9; ++i) results.push_back(contact(1e-3 * i));
  results.push_back(contact(std::nullopt));
  const auto groups = groups_of(without_grid(10), results);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].missed, 1U);
  EXPECT_NEAR(*groups[0].median, 5e-3, 1e-15);
  EXPECT_NEAR(*groups[0].p90, 9e-3, 1e-15);
  results.push_back(contact(0.2));  // later than 100 ms
  const auto later = groups_of(without_grid(11), results);
  EXPECT_EQ(later[0].missed, 2U);
  EXPECT_FALSE(later[0].p90) << "more than a tenth was missed";
}

TEST(AGroup, HasItsRateOfFalseAlarmsWithItsBound) {
  std::vector<RunResult> results(1000, contact(std::nullopt, "none"));  // one hour
  results[3].estimators[0].false_alarm = true;
  const auto groups = groups_of(without_grid(1000), results);
  EXPECT_NEAR(groups[0].false_alarms_per_hour, 1.0, 1e-9);
  EXPECT_NEAR(groups[0].false_alarms_per_hour_at_most, 4.7439, 1e-3);  // half of chi-square 9.4877
  EXPECT_FALSE(groups[0].missed_at_most);
}

TEST(AContactAfterAFalseAlarm, IsNoContactThatWasNoticedOrMissed) {
  std::vector<RunResult> results = {contact(1e-3), contact(1e-3)};
  results[1].estimators[0].false_alarm = true;
  const auto groups = groups_of(without_grid(2), results);
  EXPECT_EQ(groups[0].n, 2U);
  EXPECT_EQ(groups[0].contacts, 1U);
}

TEST(ARunThatAFaultEnded, FailedOnceHoweverManyEstimatorsThereAre) {
  RunResult bad = contact(4e-3);
  for (const char* name : {"filter", "imu"}) bad.estimators.push_back({.name = name});
  bad.fault = "the encoders are silent";
  RunResult good = bad;
  good.fault.clear();
  const Campaign campaign = without_grid(3);
  const CampaignResults results = {bad, good, bad};
  const auto json = nlohmann::json::parse(campaign_json(campaign, results, groups_of(campaign, results), {}));
  EXPECT_EQ(json["failed"], 2);
  ASSERT_EQ(json["groups"].size(), 3U);
  for (const auto& group : json["groups"]) EXPECT_EQ(group["faults"], 2);
}

TEST(AGroup, TellsHowLongForcesWereAboveTheirLimitAtMost) {
  std::vector<RunResult> results = {contact(1e-3), contact(1e-3), contact(1e-3)};
  results[0].over_limit = 0.004;
  results[1].over_limit = 0.03;
  const Campaign campaign = without_grid(3);
  const auto json = nlohmann::json::parse(campaign_json(campaign, results, groups_of(campaign, results), {}));
  EXPECT_EQ(json["groups"][0]["over_limit_ms_max"], 30.0);
}

TEST(TheTables, HaveOneGroupForEachBody) {
  const Campaign campaign = without_grid(3);
  const CampaignResults results = {contact(4e-3), contact(5e-3, "link1"), contact(std::nullopt, "none")};
  const auto groups = groups_of(campaign, results);
  EXPECT_EQ(groups.size(), 3U);
  const std::string table = campaign_table(campaign, groups, {.runs_now = 3, .wall = 0.5});
  EXPECT_THAT(table, HasSubstr("Some contacts: 3 runs, 3 of them now, 6 a second"));
  const auto json =
      nlohmann::json::parse(campaign_json(campaign, results, groups, {.runs_now = 3, .wall = 0.5}));
  EXPECT_EQ(json["campaign"], "some");
  EXPECT_EQ(json["runs"], 3);
  EXPECT_EQ(json["failed"], 0);
  EXPECT_EQ(json["wall_s"], 0.5);
  EXPECT_EQ(json["runs_per_s"], 6.0);
  for (const char* key : {"estimator", "body", "n", "missed", "median_ms", "p90_ms", "false_alarms_per_h"})
    EXPECT_TRUE(json["groups"][0].contains(key)) << key;
  EXPECT_EQ(json["groups"][1]["body"], "none");
  EXPECT_TRUE(json["groups"][1]["median_ms"].is_null());
}

}  // namespace
}  // namespace flinch
