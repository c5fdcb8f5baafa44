#include "experiments/campaign/campaign_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "experiments/campaign/campaign.h"
#include "systems/foundation/setup_error.h"
#include "tests/experiments/campaign/small_campaign.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::string value(const CampaignRun& run, const std::string& key) {
  for (const auto& [name, text] : run.values) {
    if (name == key) return text;
  }
  return "";
}

TEST(ARunOfACampaign, FollowsFromItsNumberAlone) {
  const test::Workplace place;
  const Campaign campaign = test::small_campaign(place);
  for (const std::size_t number : {0U, 5U, 11U}) {
    const CampaignRun once = draw_run(campaign, number), again = draw_run(campaign, number);
    EXPECT_EQ(once.scenario.text, again.scenario.text);
    EXPECT_EQ(once.seed, again.seed);
    EXPECT_EQ(once.values, again.values);
  }
}

TEST(ARunOfACampaign, IsAWholeScenarioWithTheDrawnValues) {
  const test::Workplace place;
  const Campaign campaign = test::small_campaign(place);
  const CampaignRun run = draw_run(campaign, 4);
  place.write("scenarios/alone.yaml", run.scenario.text);
  const SimulatedScenario alone = read_simulated_scenario(place / "scenarios/alone.yaml");
  EXPECT_EQ(alone.seed, run.seed);
  EXPECT_THAT(alone.text, HasSubstr("speed_m_per_s: " + value(run, "motion.speed_m_per_s")));
  EXPECT_THAT(alone.text, HasSubstr("x_m: " + value(run, "x_m")));
}

TEST(TheGrid, TakesEveryCombinationAndDrawsTheSameAtEachPoint) {
  const test::Workplace place;
  const Campaign campaign = test::small_campaign(place);
  std::set<std::pair<std::string, std::string>> points;
  for (std::size_t number = 0; number < campaign.runs(); ++number) {
    const CampaignRun run = draw_run(campaign, number);
    const std::string body = value(run, "contact");
    points.insert({value(run, "control.momentum_observer.gain_per_s"), body.substr(body.find('_') + 1)});
    EXPECT_EQ(run.seed, draw_run(campaign, run.draw).seed) << "paired comparisons";
  }
  EXPECT_EQ(points.size(), 4U);
}

TEST(Draws, StayBetweenTheirBoundsAndFillThem) {
  const test::Workplace place;
  Campaign campaign = test::small_campaign(place, 60);
  campaign.contact.reset();
  double lowest = 1e9, highest = 0.0, sum_of_logs = 0.0;
  for (std::size_t number = 0; number < 60; ++number) {
    const double stiffness = std::stod(value(draw_run(campaign, number), "pylon.stiffness_N_per_m"));
    lowest = std::min(lowest, stiffness);
    highest = std::max(highest, stiffness);
    sum_of_logs += std::log(stiffness);
  }
  EXPECT_GE(lowest, 2000.0);
  EXPECT_LE(highest, 20000.0);
  EXPECT_LT(lowest, 3000.0);
  EXPECT_GT(highest, 14000.0);
  EXPECT_NEAR(sum_of_logs / 60.0, 0.5 * (std::log(2000.0) + std::log(20000.0)), 0.3);
}

TEST(ADrawThatIsImpossible, IsDrawnAgain) {
  const test::Workplace place;
  Campaign campaign = test::small_campaign(place, 20);
  campaign.contact.reset();
  campaign.drawn.push_back({.key = "motion.pose.x_mm", .from = -400.0, .to = 400.0});
  int attempts = 0;
  for (std::size_t number = 0; number < 20; ++number) attempts += draw_run(campaign, number).attempts;
  EXPECT_GT(attempts, 20) << "the legs do not reach all of these poses";
}

std::string problem_of(const Campaign& campaign, std::size_t number, int most_attempts = 200) {
  try {
    draw_run(campaign, number, most_attempts);
  } catch (const SetupError& error) {
    return error.problems().front();
  }
  return "";
}

TEST(ARunThatCannotBeMade, TellsTheCauseThenItselfAndTheFirstValuesThatWereDrawn) {
  const test::Workplace place;
  Campaign campaign = test::small_campaign(place);
  campaign.drawn.push_back({.key = "motion.speed_m_per_s", .from = -1.0, .to = -1.0});
  const std::string problem = problem_of(campaign, 2);
  EXPECT_THAT(problem, HasSubstr("motion.speed_m_per_s: is -1; it must be"));
  EXPECT_THAT(problem,
              HasSubstr(" (run 2: control.momentum_observer.gain_per_s = [20, 20, 20], motion.direct"));
  EXPECT_THAT(problem, EndsWith(" more)"));
  EXPECT_LT(problem.find("must be"), problem.find("(run 2: "));
}

TEST(ARunThatCannotBeMade, HasAKeyThatNoDrawMendsAndIsDrawnOnce) {
  const test::Workplace place;
  Campaign campaign = test::small_campaign(place);
  campaign.drawn.push_back({.key = "motion.sped_m_per_s", .from = 1.0, .to = 2.0});
  const std::string first = problem_of(campaign, 0, 1);
  EXPECT_THAT(first, HasSubstr("motion.sped_m_per_s: is not a known key; did you mean"));
  EXPECT_EQ(problem_of(campaign, 0, 200), first) << "a second draw has other values";
}

TEST(ARunThatCannotBeMade, IsDrawnOnceWhereNoDrawCanMendIt) {
  const test::Workplace place;
  test::small_campaign(place);
  place.replace("campaigns/small.yaml", "contact: {body: [platform, link2]}", "");
  place.replace("campaigns/small.yaml", "from: 0, to: 360", "from: 275, to: 285");  // which all can be
  const auto first_draw = [&] {
    const CampaignRun run = draw_run(read_campaign(place / "campaigns/small.yaml"), 0);
    EXPECT_EQ(run.attempts, 1);
    return "motion.direction_deg = " + value(run, "motion.direction_deg");
  }();
  place.replace("campaigns/small.yaml", "[20, 20, 20]", "[20, -20, 20]");
  EXPECT_THAT(problem_of(read_campaign(place / "campaigns/small.yaml"), 0), HasSubstr(first_draw));
}

TEST(ARunThatCannotBeMade, NamesTheLineOfAValueOfTheGrid) {
  const test::Workplace place;
  test::small_campaign(place);
  place.replace("campaigns/small.yaml", "[20, 20, 20]", "[20, -20, 20]");
  const int line = place.line_of("campaigns/small.yaml", "-20");
  EXPECT_THAT(
      problem_of(read_campaign(place / "campaigns/small.yaml"), 0),
      HasSubstr("small.yaml:" + std::to_string(line) + ": control.momentum_observer.gain_per_s[1]: is -20"));
}

TEST(ARunThatCannotBeMade, NamesTheOptionThatAsksForIt) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::string option = "control.contact_detector.reaction_force_N=-3";
  EXPECT_THAT(problem_of(read_campaign(place / "campaigns/small.yaml", {.set = {option}}), 0),
              StartsWith("--set " + option + ": control.contact_detector.reaction_force_N: is -3"));
}

TEST(DoubtsAboutCalibrations, AreToldOfEveryValueOfTheGrid) {
  const test::Workplace place;
  const std::string axis =
      "grid:\n  - {key: control.momentum_observer.gain_per_s, values: [[20, 20, 20], [40, 40, 40]]}\n"
      "  - {key: control.disturbance_filter.pole_per_s, values: [";
  const auto warnings = [&](const std::string& poles) {
    place.write("campaigns/own.yaml", "scenario: " FLINCH_SOURCE_DIR
                                      "/apps/scenarios/platform_collision_fused.yaml\nruns: 1\n" +
                                          axis + poles + "]}\n");
    return check_keys(read_campaign(place / "campaigns/own.yaml"));
  };
  const auto of_gain = warnings("300");  // the thresholds are of 20 1/s
  ASSERT_EQ(of_gain.size(), 1U);
  EXPECT_THAT(of_gain[0].sentence, HasSubstr("control.momentum_observer.gain"));
  const auto of_both = warnings("300, 150");
  ASSERT_EQ(of_both.size(), 2U);
  EXPECT_THAT(of_both[1].sentence, HasSubstr("control.disturbance_filter.pole"));
}

/// A campaign that varies the speed of a motion, an entry a line, and draws nothing.
std::vector<std::string> problems_of_speeds(const std::string& key, const std::vector<std::string>& values) {
  const test::Workplace place;
  std::string text =
      "scenario: ../scenarios/platform_collision.yaml\nruns: 1\ngrid:\n  - key: " + key + "\n    values:\n";
  for (const std::string& value : values) text += "      - " + value + "\n";
  place.write("campaigns/own.yaml", text);
  return test::problems_of([&] { check_keys(read_campaign(place / "campaigns/own.yaml")); });
}

TEST(TheGridOfACampaign, IsRefusedForALaterValueThatNoDrawMends) {
  EXPECT_THAT(problems_of_speeds("motion.speed_m_per_s", {"0.5", "0.6", "-1"}),
              ElementsAre(HasSubstr("own.yaml:8: motion.speed_m_per_s: is -1")));
  EXPECT_THAT(problems_of_speeds("motion.speed_m_per_s", {"0.5", "0.6"}), IsEmpty());
}

TEST(TheGridOfACampaign, HasAMisspeltKeyOnceWhateverItsValues) {
  EXPECT_THAT(problems_of_speeds("motion.sped_m_per_s", {"0.5", "0.6", "0.7"}),
              ElementsAre(HasSubstr("motion.sped_m_per_s")));
}

}  // namespace
}  // namespace flinch
