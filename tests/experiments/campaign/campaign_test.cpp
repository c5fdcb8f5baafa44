#include "experiments/campaign/campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/campaign/campaign_run.h"
#include "systems/config/config_node.h"
#include "systems/config/parameter_file.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"
#include "tests/experiments/campaign/small_campaign.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

std::vector<std::string> problems_of(const std::filesystem::path& file,
                                     const CampaignOverrides& overrides = {}) {
  try {
    check_keys(read_campaign(file, overrides));
  } catch (const SetupError& error) {
    return error.problems();
  }
  return {};
}

TEST(ReadingACampaign, FindsScenarioGridAndDraws) {
  const test::Workplace place;
  const Campaign campaign = test::small_campaign(place, 7);
  EXPECT_EQ(campaign.scenarios.size(), 1U);
  EXPECT_EQ(campaign.grid.size(), 1U);
  EXPECT_EQ(campaign.drawn.size(), 3U);
  EXPECT_EQ(campaign.grid_points(), 4U) << "two gains, two bodies";
  EXPECT_EQ(campaign.runs(), 28U);
}

TEST(ReadingACampaign, TellsAllThatIsWrong) {
  const test::Workplace place;
  place.write("campaigns/bad.yaml",
              "scenario: ../scenarios/nothing.yaml\n"
              "runs: 0\n"
              "contact: {body: [elbow]}\n"
              "draw:\n"
              "  - {key: a, from: 2, to: 1}\n"
              "  - {key: b, from: 0, to: 1, scale: logarithmic}\n"
              "  - {key: c}\n");
  EXPECT_THAT(
      problems_of(place / "campaigns/bad.yaml"),
      ElementsAre(HasSubstr("bad.yaml:1: scenario: is '../scenarios/nothing.yaml': no such file"),
                  HasSubstr("bad.yaml:2: runs: is 0"), HasSubstr("bad.yaml:3: contact.body[0]: is 'elbow'"),
                  HasSubstr("bad.yaml:5: draw[0].to: is below 'from'"),
                  HasSubstr("bad.yaml:6: draw[1].from: is not positive"),
                  HasSubstr("bad.yaml:7: draw[2]: has none of of, from")));
}

TEST(ReadingACampaign, RefusesKeysThatChangeNothingOfARun) {
  const test::Workplace place;
  test::small_campaign(place);
  place.write("campaigns/bad.yaml",
              "scenario: ../scenarios/platform_collision.yaml\n"
              "grid: [{key: seed, values: [7, 8]}]\n"
              "draw: [{key: title, of: [a, b]}]\n");
  EXPECT_THAT(problems_of(place / "campaigns/bad.yaml"),
              ElementsAre(HasSubstr("bad.yaml:2: grid[0].key: is 'seed', but each run has a seed of its own"),
                          HasSubstr("bad.yaml:3: draw[0].key: is 'title', which changes nothing of a run")));
  EXPECT_THAT(problems_of(place / "campaigns/small.yaml", {.set = {"seed=1,2"}}),
              ElementsAre(HasSubstr("--set seed=1,2: the key is 'seed', but each run")));
}

TEST(ReadingACampaign, RefusesToVaryAKeyTwice) {
  const test::Workplace place;
  test::small_campaign(place);
  place.write("campaigns/bad.yaml",
              "scenario: ../scenarios/platform_collision.yaml\n"
              "grid:\n"
              "  - {key: pylon.radius_mm, values: [20, 30]}\n"
              "  - {key: duration_s, values: [1]}\n"
              "  - {key: duration_s, values: [2]}\n"
              "draw:\n"
              "  - {key: pylon.radius_m, from: 0.02, to: 0.03}\n");
  EXPECT_THAT(problems_of(place / "campaigns/bad.yaml"),
              ElementsAre(HasSubstr("bad.yaml:5: grid[2].key: is 'duration_s', but 'duration_s' is varied"),
                          HasSubstr("bad.yaml:7: draw[0].key: is 'pylon.radius_m', but 'pylon.radius_mm' is "
                                    "varied already; keep one of them")));
}

TEST(ReadingACampaign, RefusesAGridThatIsTooLargeForAnyMachine) {
  const test::Workplace place;
  std::string text = "scenario: ../scenarios/platform_collision.yaml\nruns: 10000000\ngrid:\n";
  for (int axis = 0; axis < 20; ++axis)
    text += "  - {key: a.b" + std::to_string(axis) + ", values: [1, 2, 3, 4, 5, 6, 7, 8]}\n";
  place.write("campaigns/endless.yaml", text);
  EXPECT_THAT(problems_of(place / "campaigns/endless.yaml"),
              ElementsAre(HasSubstr("endless.yaml: asks for 1.152921504606847e+25 runs")));
}

TEST(ReadingACampaign, RefusesMoreValuesThanAreTriedInAMoment) {
  const test::Workplace place;
  const auto list = [](const std::string& entry, int count) {
    std::string text = "[" + entry;
    for (int i = 1; i < count; ++i) text += ", " + entry;
    return text + "]";
  };
  const std::string one = "scenario: ../scenarios/platform_collision.yaml\n";
  const std::string bad = "campaigns/bad.yaml";
  place.write(bad, one + "grid:\n  - {key: motion.speed_m_per_s, values: " + list("1", 5001) +
                       "}\n  - {key: pylon.radius_mm, values: " + list("30", 5000) + "}\n");
  EXPECT_THAT(problems_of(place / bad),
              ElementsAre(HasSubstr("bad.yaml:2: grid: has 10001 entries in all; it may have 10000")));
  place.write(bad, one + "draw:\n  - {key: motion.speed_m_per_s, of: " + list("1", 10'001) + "}\n");
  EXPECT_THAT(problems_of(place / bad), ElementsAre(HasSubstr("bad.yaml:2: draw: has 10001 entries in all")));
  place.write(bad, "scenarios: " + list("{file: ../scenarios/square.yaml}", 1001) + "\n");
  EXPECT_THAT(problems_of(place / bad),
              ElementsAre(HasSubstr("bad.yaml:1: scenarios: has 1001 entries in all; it may have 1000")));
}

TEST(ReadingACampaign, NamesTheLineOfEachKeyThatTheScenarioDoesNotHave) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::string file = "campaigns/small.yaml";
  place.replace(file, "control.momentum_observer.gain_per_s", "control.momentum_observer.gian_per_s");
  place.replace(file, "motion.direction_deg", "motoin.direction_deg");
  place.replace(file, "motion.speed_m_per_s", "motion.speed_m_per_s2");
  const auto at = [&](const char* key) {
    return StartsWith(place.at(file) + ":" + std::to_string(place.line_of(file, key)) + ": ");
  };
  EXPECT_THAT(
      problems_of(place / file),
      UnorderedElementsAre(
          AllOf(at("gian"), HasSubstr("gian_per_s: is not a known key; did you mean 'gain_per_s'?")),
          AllOf(at("motoin"), HasSubstr("motoin: is not a known key; did you mean 'motion'?")),
          AllOf(at("speed"), HasSubstr("motion.speed_m_per_s2: has the wrong unit, m_per_s2; write"))));
}

TEST(ReadingACampaign, NamesTheLineOfAKeyWithinAValue) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::string file = "campaigns/small.yaml";
  place.replace(file, "motion.speed_m_per_s", "motion.speed_m_per_s.x_m");
  EXPECT_THAT(problems_of(place / file),
              ElementsAre(AllOf(StartsWith(place.at(file) + ":"), HasSubstr("has no keys in this file"))));
}

TEST(ReadingACampaign, SaysWhereAnEntryOfAListThatItGaveStands) {
  const test::Workplace place;
  place.write("scenarios/post.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 1\nobstacles: [{x_m: 1, y_m: 1}]\n");
  place.write("campaigns/bad.yaml",
              "scenario: ../scenarios/post.yaml\n\n\ngrid: [{key: 'obstacles[0]', values: [{x_m: 2}]}]\n");
  EXPECT_THAT(test::problems_of([&] { draw_run(read_campaign(place / "campaigns/bad.yaml"), 0); }),
              ElementsAre(StartsWith(place.at("campaigns/bad.yaml") +
                                     ":4: obstacles[0].y_m: is missing; it must be")));
}

TEST(ReadingACampaign, LeavesValuesToTheRuns) {
  const test::Workplace place;
  test::small_campaign(place);
  place.replace("campaigns/small.yaml", "from: 0.5, to: 1.2", "from: -0.5, to: 1.2");
  EXPECT_THAT(problems_of(place / "campaigns/small.yaml"), IsEmpty());
}

TEST(TheCommandLine, AddsAxesAndReplacesWhatTheFileSaysOfAKey) {
  const test::Workplace place;
  test::small_campaign(place);
  const Campaign campaign = read_campaign(
      place / "campaigns/small.yaml",
      {.set = {"motion.speed_m_per_s=0.5,0.9", "control.momentum_observer.gain_per_s=[30, 30, 30]"},
       .draws = 5,
       .seed = 9});
  EXPECT_EQ(campaign.drawn.size(), 2U) << "the speed is drawn no longer";
  ASSERT_EQ(campaign.grid.size(), 2U);
  EXPECT_EQ(yaml_line(*campaign.grid[0].values.at(0)), "[30, 30, 30]");
  EXPECT_EQ(yaml_line(*campaign.grid[1].values.at(1)), "0.9");
  EXPECT_EQ(campaign.runs(), 2U * 2U * 5U);
  EXPECT_EQ(campaign.seed, 9U);
}

TEST(TheCommandLine, ReplacesWhatTheFileSaysInAnotherUnit) {
  const test::Workplace place;
  test::small_campaign(place);
  const Campaign campaign =
      read_campaign(place / "campaigns/small.yaml", {.set = {"pylon.stiffness_kN_per_m=5", "duration_s=1"}});
  EXPECT_EQ(campaign.drawn.size(), 2U) << "the stiffness is drawn no longer";
  const CampaignRun run = draw_run(campaign, 0);
  const auto is_stiffness = [](const auto& value) { return value.first.starts_with("pylon.stiffness"); };
  EXPECT_EQ(std::count_if(run.values.begin(), run.values.end(), is_stiffness), 1);
}

TEST(TheCommandLine, CannotPlaceWhatTheContactPlaces) {
  const test::Workplace place;
  test::small_campaign(place);
  const Campaign campaign = read_campaign(place / "campaigns/small.yaml", {.set = {"pylon.y_mm=500"}});
  EXPECT_THAT(test::problems_of([&] { draw_run(campaign, 0); }),
              ElementsAre(HasSubstr("'pylon.y_mm' is varied, but 'contact' draws where the obstacle is")));
}

TEST(TheCommandLine, IsToldWhatIsNoKeyWithValues) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::filesystem::path file = place / "campaigns/small.yaml";
  EXPECT_THAT(problems_of(file, {.set = {"gain", "a="}}),
              ElementsAre(HasSubstr("--set gain: is not of the form KEY=VALUE"),
                          HasSubstr("--set a=: gives no value")));
  EXPECT_THAT(problems_of(file, {.set = {"a=[1"}}), ElementsAre(HasSubstr("is not valid YAML")));
}

TEST(DetectionAndFalseAlarmsOverRates, HaveTheSameThresholdsAndDetectors) {
  const auto grid = [](const char* name) {
    const Campaign campaign = read_campaign(std::string(FLINCH_SOURCE_DIR "/apps/campaigns/") + name);
    EXPECT_EQ(campaign.grid.at(0).key, "calibrations") << name;
    EXPECT_THAT(campaign.grid.at(0).values, SizeIs(3)) << name;
    std::vector<std::string> lines;
    for (const CampaignAxis& axis : campaign.grid) {
      for (const auto& value : axis.values) lines.push_back(axis.key + ": " + yaml_line(*value));
    }
    return lines;
  };
  EXPECT_EQ(grid("detection_rates.yaml"), grid("false_alarms_rates.yaml"))
      << "else a time and its false alarms do not belong together";
}

TEST(TheIdentityOfACampaign, ChangesWithWhateverDecidesAboutItsResults) {
  const test::Workplace place;
  const Campaign campaign = test::small_campaign(place);
  const std::filesystem::path file = place / "campaigns/small.yaml";
  EXPECT_EQ(read_campaign(file).identity(), campaign.identity());
  EXPECT_NE(read_campaign(file, {.seed = 2}).identity(), campaign.identity());
  EXPECT_NE(read_campaign(file, {.draws = 4}).identity(), campaign.identity());
  EXPECT_NE(read_campaign(file, {.set = {"motion.speed_m_per_s=0.5"}}).identity(), campaign.identity());
  place.replace("robots/planar_3rrr.yaml", "# The platform. Its", "# The platform, whose");
  EXPECT_NE(read_campaign(file).identity(), campaign.identity()) << "the file of the robot counts, too";
}

TEST(Campaign, HasAnotherIdentityWithAnotherCalibrationOfItsRobot) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::string robot = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/planar_3rrr.yaml", robot + "\ncalibrations: [{file: found.yaml}]\n");
  const auto identity = [&](double constant) {
    ParameterFile found;
    found.kind = "torque-constant";
    found.date = "2026-11-22";
    found.robot = {"planar_3rrr.yaml", calibrated_robot_hash(robot)};
    for (int i = 0; i < 3; ++i) {
      found.parameters.push_back({.name = "drives.torque_constant_Nm_per_A[" + std::to_string(i) + "]",
                                  .value = constant,
                                  .belongs_to = "robot"});
    }
    place.write("robots/found.yaml", parameter_file_text(found));
    return read_campaign(place / "campaigns/small.yaml").identity();
  };
  EXPECT_EQ(identity(7.0), identity(7.0));
  EXPECT_NE(identity(7.0), identity(7.1));
}

TEST(Campaign, ThatVariesFilesOfWhichOneIsNoGoodIsRefusedAtOnce) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::filesystem::path file = place / "campaigns/small.yaml";
  const std::string thresholds = "calibrations/mismatched_thresholds.yaml";
  place.replace(thresholds, "by_estimator", "by_estimatr");
  const std::string refused =
      "mismatched_thresholds.yaml:" + std::to_string(place.line_of(thresholds, "by_estimatr")) +
      ": control.contact_detector.by_estimatr";
  EXPECT_THAT(
      problems_of(file, {.set = {"calibrations=[{file: ../calibrations/bench_thresholds.yaml}],[{file: "
                                 "../calibrations/mismatched_thresholds.yaml}],[{file: gone.yaml}]"}}),
      ElementsAre(HasSubstr(refused), HasSubstr("calibrations[0].file: is 'gone.yaml': no such file")));
  const std::string robot = test::bytes_of(place / "robots/planar_3rrr.yaml");
  place.write("robots/calibrated.yaml",
              robot + "\ncalibrations: [{file: ../calibrations/mismatched_thresholds.yaml}]\n");
  EXPECT_THAT(problems_of(file, {.set = {"robot=../robots/planar_3rrr.yaml,../robots/calibrated.yaml"}}),
              ElementsAre(HasSubstr(refused)));
  EXPECT_THAT(problems_of(file, {.set = {"robot=../robots/planar_3rrr.yaml,../robots/gone.yaml"}}),
              ElementsAre(HasSubstr("robot: is '../robots/gone.yaml': no such file")));
}

TEST(Campaign, HasAnotherIdentityWhereAFileThatItVariesHasChanged) {
  const test::Workplace place;
  test::small_campaign(place);
  const std::string thresholds = "calibrations/bench_thresholds.yaml";
  const auto identity = [&] {
    return read_campaign(place / "campaigns/small.yaml",
                         {.set = {"calibrations=[{file: ../calibrations/mismatched_thresholds.yaml}],[{file: "
                                  "../calibrations/bench_thresholds.yaml}]"}})
        .identity();
  };
  const std::string before = identity();
  EXPECT_TRUE(identity() == before);
  place.write(thresholds, test::bytes_of(place / thresholds) + "# seen\n");
  EXPECT_TRUE(identity() != before);
}

TEST(Campaign, HasAnotherIdentityWhereANetworkThatAScenarioNamesHasChanged) {
  const test::Workplace place;
  test::small_campaign(place);
  place.write("own.onnx", "a network");
  place.write("other.onnx", "another");
  const auto identity = [&](const std::string& networks) {
    return read_campaign(place / "campaigns/small.yaml",
                         {.set = {"control.isolation.learned_classifier.network=" + networks}})
        .identity();
  };
  const std::string one = identity("../own.onnx"), two = identity("../own.onnx,../other.onnx");
  EXPECT_EQ(identity("../own.onnx"), one);
  place.write("other.onnx", "trained longer");
  EXPECT_EQ(identity("../own.onnx"), one);
  EXPECT_NE(identity("../own.onnx,../other.onnx"), two);
  place.write("own.onnx", "trained longer");
  EXPECT_NE(identity("../own.onnx"), one);
}

}  // namespace
}  // namespace flinch
