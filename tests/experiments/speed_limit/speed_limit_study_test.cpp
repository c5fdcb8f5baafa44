#include "experiments/speed_limit/speed_limit_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "experiments/campaign/run_campaign.h"
#include "experiments/campaign/run_result.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/speed_limit/speed_limit_output.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bound = FoundSpeed::Bound;

class ASpeedLimit : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"whole", "other"}) std::filesystem::create_directories(place / folder);
    settings.scenario = place / "scenarios/platform_collision.yaml";
    settings.bodies = {"platform"};
    settings.places = {{-0.04, 0.0}};
    settings.directions_deg = {180.0};
  }

  std::vector<std::string> problems() const {
    return test::problems_of([this] { read_speed_limit_study(settings); });
  }
  std::vector<SpeedLimit> limits_in(const std::string& folder, std::size_t threads = 2) const {
    const SpeedLimitStudy study = read_speed_limit_study(settings);
    return speed_limits_of(study, run_campaign(study.campaign, place / folder, threads));
  }

  /// Fractions of contacts beyond a limit at two speeds of the same motion, in a campaign of its own.
  std::vector<double> beyond_limits(double slow, double fast, std::size_t runs) const {
    place.write("campaigns/direct.yaml",
                "scenario: ../scenarios/platform_collision.yaml\nseed: 77\nruns: " + std::to_string(runs) +
                    "\ncontact: {body: [platform]}\ngrid:\n"
                    "  - {key: plant.realism, values: [bench]}\n"
                    "  - {key: motion.speed_m_per_s, values: [" +
                    std::to_string(slow) + ", " + std::to_string(fast) + "]}\n");
    const Campaign direct = read_campaign(place / "campaigns/direct.yaml");
    std::filesystem::create_directories(place / "direct");
    std::vector<double> fractions(2, 0.0);
    for (const RunResult& result : run_campaign(direct, place / "direct", 2))
      fractions[result.point] += result.over_limit > 0.0 ? 1.0 / static_cast<double>(runs) : 0.0;
    return fractions;
  }

  test::Workplace place;
  SpeedLimitSettings settings;
};

/// Other draws, other noise, other robots, and none of the code that searches.
TEST_F(ASpeedLimit, AgreesWithACampaignWithinATenthOfTheSpeed) {
  settings.slowest = 0.8;
  settings.runs = 61;  // of which two may exceed
  const std::vector<SpeedLimit> limits = limits_in("whole");
  ASSERT_EQ(limits.size(), 1U);
  ASSERT_TRUE(limits[0].found && limits[0].found->speed) << limits[0].reason;
  EXPECT_EQ(limits[0].found->bound, Bound::force);
  EXPECT_GE(limits[0].confidence, settings.confidence);
  const double speed = *limits[0].found->speed;
  const std::vector<double> beyond = beyond_limits(0.9 * speed, 1.1 * speed, 60);
  EXPECT_LT(beyond[0], settings.share) << "below " << speed << " m/s";
  EXPECT_GT(beyond[1], settings.share) << "above " << speed << " m/s";
}

TEST_F(ASpeedLimit, IsTheSameForAnyNumberOfThreadsAndHoweverOftenItIsStopped) {
  settings.places = {{-0.04, 0.0}, {0.9, 0.0}};
  settings.bodies = {"platform", "link2"};
  settings.slowest = 0.8;
  settings.share = 0.3;
  settings.step = 0.2;
  const SpeedLimitStudy study = read_speed_limit_study(settings);
  const std::string whole = speed_limit_json(study, limits_in("whole", 1));
  std::size_t done = 0;
  while (done < study.cells.size()) {
    const std::size_t before = done;
    done = run_campaign(study.campaign, place / "other", 1, [before](std::size_t now, std::size_t) {
             return now == before;
           }).size();
    ASSERT_GT(done, before);
  }
  EXPECT_EQ(speed_limit_json(study, limits_in("other", 3)), whole);
  EXPECT_EQ(test::bytes_of(place / "other/results.csv"), test::bytes_of(place / "whole/results.csv"));
}

TEST_F(ASpeedLimit, HasNoneWhereThePlatformCannotBe) {
  settings.places = {{0.9, 0.0}};
  const std::vector<SpeedLimit> limits = limits_in("whole");
  EXPECT_FALSE(limits[0].found);
  EXPECT_THAT(limits[0].reason, HasSubstr("the legs do not reach the pose"));
}

TEST_F(ASpeedLimit, IsLowerWhereTheBodyBearsLess) {
  settings.share = 0.3;
  settings.region = "hand";
  const double hand = limits_in("whole")[0].found->speed.value();
  settings.region = "face";
  const double face = limits_in("other")[0].found->speed.value();
  EXPECT_LT(face, 0.5 * hand) << "65 N against 280 N";
}

/// Between two links nothing gets out of the way.
TEST_F(ASpeedLimit, HoldsClampingsToTheQuasiStaticLimitAtOnce) {
  settings.scenario = place / "scenarios/clamping.yaml";
  settings.bodies = {"clamping"};
  settings.places = {{0.07, 0.014}};
  settings.directions_deg = {-42.0};
  settings.share = 0.5;
  settings.fastest = settings.slowest = 0.2;
  const std::vector<SpeedLimit> limits = limits_in("whole");
  ASSERT_TRUE(limits[0].found && limits[0].found->speed) << limits[0].reason;
  EXPECT_EQ(limits[0].nearest.transient_limit, 140.0);
  EXPECT_EQ(limits[0].nearest.body, "clamping");
}

TEST_F(ASpeedLimit, TellsHowItsNearestRunIsRepeated) {
  settings.slowest = 0.8;
  settings.share = 0.3;
  const SpeedLimitStudy study = read_speed_limit_study(settings);
  const SpeedLimit limit = limits_in("whole").front();
  std::vector<std::string> set;
  for (const auto& [key, value] : values_of_run(study, limit)) set.push_back(key + "=" + value);
  const Verdict verdict =
      judge_experiment(read_simulated_scenario(settings.scenario, set, limit.nearest.seed));
  ASSERT_EQ(verdict.contacts.size(), 1U);
  EXPECT_EQ(verdict.contacts.front().peak_force, limit.nearest.peak_force);
  EXPECT_EQ(verdict.contacts.front().lasting_force, limit.nearest.lasting_force);
}

TEST_F(ASpeedLimit, HasTheSameContactsInWhateverMapThePlaceIs) {
  settings.slowest = 0.8;
  settings.share = 0.3;
  settings.step = 0.2;
  const SpeedLimit alone = limits_in("whole").front();
  settings.places = {{0.02, 0.03}, {-0.04, 0.0}};
  const SpeedLimit among_others = limits_in("other").back();
  EXPECT_EQ(among_others.found, alone.found);
  EXPECT_EQ(among_others.nearest.seed, alone.nearest.seed);
}

TEST_F(ASpeedLimit, IsOfRobotsThatDifferFromTheirModelUnlessTheScenarioSaysSo) {
  EXPECT_THAT(read_speed_limit_study(settings).added, ElementsAre(std::pair("plant.realism", "bench")));
  settings.set = {"plant.realism=none"};
  EXPECT_TRUE(read_speed_limit_study(settings).added.empty());
}

TEST_F(ASpeedLimit, AsksForEveryBodyThatTheRobotHas) {
  settings.bodies.clear();
  settings.places.clear();
  settings.grid = 3;
  settings.directions_deg = {0.0, 90.0};
  const SpeedLimitStudy study = read_speed_limit_study(settings);
  std::vector<std::string> first;
  for (std::size_t i = 0; i < 4; ++i) first.push_back(study.cells[i].body);
  EXPECT_THAT(first, ElementsAre("platform", "link1", "link2", "platform"));
  EXPECT_EQ(study.cells.size() % 6, 0U);
}

TEST_F(ASpeedLimit, SaysWhatIsWrong) {
  settings.region = "hnad";
  settings.runs = 10;
  settings.slowest = 3.0;
  EXPECT_THAT(problems(),
              ElementsAre(HasSubstr("--region: is 'hnad', which is no region of the body that has "
                                    "limits; did you mean 'hand'?"),
                          HasSubstr("--slowest: is 3 m/s, above the --fastest of 2 m/s"),
                          HasSubstr("--runs: is 10; even if all are within the limits, that shows "
                                    "fewer than 10 % beyond them with a confidence of 65.1 %")));
  settings = {.scenario = place / "scenarios/square.yaml"};
  EXPECT_THAT(problems(),
              ElementsAre(HasSubstr("square.yaml:10: motion.kind: is 'square'; it must be 'passage'"),
                          HasSubstr("square.yaml: has neither 'pylon' nor 'obstacles'")));
  settings = {.scenario = place / "scenarios/hexapod_collision.yaml", .bodies = {"clamping", "arm"}};
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("--body clamping: this robot has no such contact; it may be "
                                                "platform, link1, link2"),
                                      HasSubstr("--body arm: ")));
  settings = {.scenario = place / "scenarios/platform_collision.yaml", .height = 0.3};
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("--z: this robot moves in a plane")));
  settings.height.reset();
  settings.set = {"pylon.radios_mm=3"};
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("pylon.radios_mm: is not a known key")));
}

TEST_F(ASpeedLimit, IsFoundInSpaceAtTheHeightThatIsAskedFor) {
  settings.scenario = place / "scenarios/delta_collision.yaml";
  settings.places = {{0.0, 0.0}};
  settings.directions_deg = {0.0};
  settings.height = -0.6;
  settings.share = 0.5;
  settings.fastest = settings.slowest = 0.2;
  const SpeedLimitStudy study = read_speed_limit_study(settings);
  EXPECT_NEAR(study.pose[2], -0.6, 1e-12);
  const std::vector<SpeedLimit> limits = limits_in("whole");
  ASSERT_TRUE(limits[0].found) << limits[0].reason;
  EXPECT_EQ(limits[0].found->speed, 0.2);
}

}  // namespace
}  // namespace flinch
