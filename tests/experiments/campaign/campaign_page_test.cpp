#include "experiments/campaign/campaign_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/counted_alarms.h"
#include "experiments/campaign/results_file.h"
#include "experiments/campaign/run_result.h"
#include "systems/config/config_node.h"
#include "tests/experiments/campaign/small_campaign.h"
#include "tests/experiments/report/chromium.h"

namespace flinch {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

Campaign some_campaign(std::size_t draws) {
  Campaign campaign;
  campaign.file = "campaigns/some.yaml";
  campaign.title = "Some </script> contacts";
  campaign.draws = draws;
  campaign.scenarios = {"a.yaml"};
  campaign.scenario_texts = {"duration_s: 1"};
  return campaign;
}

/// Ten contacts with the platform, one of them missed; two runs that were stopped or alarmed before.
std::vector<RunResult> some_results() {
  std::vector<RunResult> results(12);
  for (std::size_t i = 0; i < results.size(); ++i) {
    RunResult& result = results[i];
    result.run = i;
    result.body = "platform";
    result.simulated = 1.2;
    result.estimators = {
        {.name = "observer", .detection_time = 1e-3 * static_cast<double>(i + 1), .contact_free = 360.0}};
  }
  results[4].estimators[0].detection_time.reset();
  results[7].fault = "the encoders are silent";
  results[9].estimators[0].false_alarm = true;
  return results;
}

json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t first = page.find(begin) + begin.size();
  return json::parse(page.substr(first, page.find("</script>", first) - first));
}

class TheCampaignPage : public ::testing::Test {
 protected:
  Campaign campaign = some_campaign(12);
  std::vector<RunResult> results = some_results();
  std::vector<CampaignGroup> groups = groups_of(campaign, results);
  std::string page =
      campaign_page(campaign, results, groups, CountedAlarms(groups), "flinch campaign some.yaml");
};

TEST_F(TheCampaignPage, NeedsNothingElse) {
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_EQ(page.find("{{ "), std::string::npos);
  EXPECT_EQ(page.find(" src="), std::string::npos);
  EXPECT_EQ(page.find("<link rel=\"stylesheet\""), std::string::npos);
}

TEST_F(TheCampaignPage, TellsTheGroupsWithTheirBounds) {
  const json data = data_of(page);
  EXPECT_EQ(data["title"], "Some </script> contacts");
  EXPECT_EQ(data["faults"], 1);
  ASSERT_EQ(data["groups"].size(), 1U);
  const json& group = data["groups"][0];
  EXPECT_EQ(group["contacts"], 11) << "the alarm came before the contact";
  EXPECT_EQ(group["missed"], 1);
  EXPECT_NEAR(group["missed_at_most"], *groups[0].missed_at_most, 1e-12);
  EXPECT_NEAR(group["quantiles"][2], *groups[0].median, 1e-12);
  EXPECT_EQ(group["false_alarms"], 1);
  EXPECT_NEAR(group["alarm_rate_at_most"], groups[0].false_alarms_per_hour_at_most, 1e-9);
}

TEST_F(TheCampaignPage, ShowsTheFalseAlarmsOfAnotherCampaignWhereTheyAreGiven) {
  const test::TemporaryFolder folder;
  RunResult hours;
  hours.estimators = {{.name = "observer", .false_alarm = true, .contact_free = 36000.0}};
  write_results({hours, hours}, folder.path());
  const CountedAlarms alarms(campaign, folder / "results.csv");
  const json data = data_of(campaign_page(campaign, results, groups, alarms, ""));
  EXPECT_EQ(data["alarm_table"], (folder / "results.csv").string());
  EXPECT_EQ(data["groups"][0]["alarms"], 2);
  EXPECT_NEAR(data["groups"][0]["alarm_hours"], 20.0, 1e-9);
  EXPECT_NEAR(data["groups"][0]["alarm_rate"], 0.1, 1e-9);
  EXPECT_EQ(data["groups"][0]["false_alarms"], 1) << "the campaign's own";
  EXPECT_EQ(data_of(page)["alarm_table"], "");
}

TEST_F(TheCampaignPage, HasAColumnForTheGridAndOneForTheEstimator) {
  for (const char* const heading :
       {"Grid point", "Detected by", "Missed at most", "False alarms at most, 1/h"})
    EXPECT_THAT(page, HasSubstr("[\"" + std::string(heading) + "\""));
}

TEST_F(TheCampaignPage, NamesTheRunsToLookAtTheWorstFirst) {
  const json look = data_of(page)["look"];
  ASSERT_GE(look.size(), 4U);
  EXPECT_EQ(look[0]["run"], 7);
  EXPECT_EQ(look[0]["why"], "fault: the encoders are silent");
  EXPECT_EQ(look[1]["run"], 9);
  EXPECT_EQ(look[1]["why"], "false alarm");
  EXPECT_EQ(look[2]["run"], 4);
  EXPECT_EQ(look[2]["why"], "missed");
  EXPECT_EQ(look[3]["run"], 11) << "the slowest";
}

TEST_F(TheCampaignPage, HasADotForEachReactionAndTheLimitsOfTheScenario) {
  const test::Workplace place;
  Campaign reactions = test::small_campaign(place);
  reactions.summary = Campaign::Summary::reactions;
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].values.assign(reactions.grid.size(), {"key", "value"});
    results[i].law = "torque_reaction";
    results[i].meant = "link2";
    results[i].removal_time = 0.1;
    results[i].speed = 0.1 * static_cast<double>(i);
    results[i].peak_force = 20.0 + 12.0 * static_cast<double>(i);
    results[i].transient_limit = 280.0;
  }
  const json shown = data_of(campaign_page(reactions, results, {}, CountedAlarms({}), ""))["reactions"];
  ASSERT_EQ(shown["runs"].size(), results.size());
  const json& dot = shown["runs"][2];
  EXPECT_EQ(dot["level"], "torque");
  EXPECT_EQ(dot["body"], "link2");
  EXPECT_NEAR(dot["detection"], 0.003, 1e-12);
  EXPECT_NEAR(dot["reaction"], 0.097, 1e-12);
  EXPECT_TRUE(shown["runs"][4]["reaction"].is_null()) << "it was not detected";
  EXPECT_TRUE(dot["kappa"].is_null());
  EXPECT_NEAR(shown["fits"][0]["slope"], 120.0, 1e-9);
  EXPECT_NEAR(shown["fits"][0]["speed_at_transient"], 260.0 / 120.0, 1e-9);
  EXPECT_TRUE(shown["fits"][0]["speed_at_quasi_static"].is_null());
  EXPECT_EQ(shown["fit_of_all"]["n"], results.size());
  EXPECT_NEAR(dot["duration"], 0.1, 1e-12);
  EXPECT_TRUE(dot["lasting"].is_null());
  EXPECT_EQ(shown["limits"]["region"], "hand and fingers");
  EXPECT_THAT(shown["limits"]["transient_source"], HasSubstr("[SafePR]"));
  EXPECT_EQ(shown["limits"]["transient_duration"], 0.5);
  EXPECT_EQ(shown["limits"]["transient"], 280.0);
  EXPECT_EQ(shown["limits"]["quasi_static"], 140.0);
  EXPECT_EQ(shown["limits"]["sigma_kappa"], 15.0);
  EXPECT_FALSE(data_of(page).contains("reactions"));
}

TEST_F(TheCampaignPage, DrawsInChromiumWhatItsDataSay) {
  const test::Workplace place;
  Campaign reactions = test::small_campaign(place);
  reactions.summary = Campaign::Summary::reactions;
  const std::string key = "control.estimators";
  const std::vector<std::string> lists = {"[momentum_observer, momentum_kalman_filter]",
                                          "[momentum_observer, sliding_mode_observer]"};
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double speed = 0.3 + 0.1 * static_cast<double>(i);
    const bool is_even = i % 2 == 0;
    results[i].point = i % 2;
    results[i].values = {{key, lists[i % 2]}};
    results[i].law = "torque_reaction";
    results[i].meant = is_even ? "link2" : "platform";
    results[i].removal_time = 0.1;
    results[i].speed = speed;
    results[i].peak_force = is_even ? 300.0 * speed - 60.0 : 110.0 - 100.0 * speed;
    results[i].transient_limit = 280.0;
  }
  reactions.grid = {{key, {parse_yaml(lists[0], ""), parse_yaml(lists[1], "")}}};
  const auto file = place / "page.html";
  write_campaign_page(reactions, results, groups_of(reactions, results), CountedAlarms({}), "", file);
  expect_works_in_chromium(file, "campaign/campaign_in_browser.py");
}

}  // namespace
}  // namespace flinch
