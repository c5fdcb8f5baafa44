#include "experiments/campaign/run_campaign.h"

#include <gtest/gtest.h>

#include <set>

#include "diagrams/estimator_stages.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_journal.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/simulated/experiment.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/random.h"
#include "systems/framework/recording.h"
#include "systems/robot/parallel_robot.h"
#include "tests/experiments/campaign/small_campaign.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using test::bytes_of;

class ACampaign : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"whole", "other"}) std::filesystem::create_directories(place / folder);
    campaign = test::small_campaign(place);
    whole = run_campaign(campaign, place / "whole", 1);
  }

  void expect_the_same_tables() const {
    for (const char* name : {"results.csv", "results.h5"}) {
      EXPECT_FALSE(bytes_of(place / ("whole/" + std::string(name))).empty());
      EXPECT_EQ(bytes_of(place / ("other/" + std::string(name))),
                bytes_of(place / ("whole/" + std::string(name))));
    }
  }

  test::Workplace place;
  Campaign campaign;
  CampaignResults whole{0, {}};
};

TEST_F(ACampaign, GivesTheSameTableForAnyNumberOfThreads) {
  for (const std::size_t threads : {2U, 4U}) {
    std::filesystem::remove(place / "other/results.part");
    run_campaign(campaign, place / "other", threads);
    expect_the_same_tables();
  }
}

TEST_F(ACampaign, GivesTheSameTableHoweverOftenItIsStoppedOnTheWay) {
  RandomGenerator random(3);
  std::size_t last = 0;
  for (int calls = 0; last < campaign.runs() && calls < 100; ++calls) {
    run_campaign(campaign, place / "other", 2, [&](std::size_t done, std::size_t before) {
      return done == before || done == campaign.runs();
    });
    // As a program that is killed may leave it.
    const std::string journal = bytes_of(place / "other/results.part");
    const bool cut = calls < 6;
    place.write("other/results.part", cut ? journal.substr(0, journal.size() - random() % 100) : journal);
    last = run_campaign(campaign, place / "other", 1, [](std::size_t, std::size_t) { return false; }).size();
  }
  EXPECT_EQ(last, campaign.runs());
  run_campaign(campaign, place / "other", 2);
  expect_the_same_tables();
}

TEST_F(ACampaign, DoesNotGoOnWhereAnotherProgramBegan) {
  const auto go_on_after = [&](double peak_force_of_the_program) {
    RunResult first = whole[2];
    first.peak_force = peak_force_of_the_program;
    std::filesystem::remove(place / "other/results.part");
    CampaignJournal(place / "other", campaign).add(first);
    return test::problems_of([&] { run_campaign(campaign, place / "other", 2); });
  };
  ASSERT_TRUE(whole[2].peak_force);
  const auto problems = go_on_after(*whole[2].peak_force + 1e-6);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.front().find((place / "other").string() + ": run 2 comes out otherwise now"), 0U)
      << problems.front();
  EXPECT_FALSE(std::filesystem::exists(place / "other/results.csv"));

  EXPECT_TRUE(go_on_after(*whole[2].peak_force).empty());
  expect_the_same_tables();
}

TEST_F(ACampaign, HasRunsThatGiveTheSameAlone) {
  for (const std::size_t number : {1U, 7U}) {
    const CampaignRun run = draw_run(campaign, number);
    EXPECT_EQ(csv_row(simulate_run(run)), csv_row(whole[number]));
    // As `flinch run` of a file with what was drawn.
    place.write("scenarios/alone.yaml", run.scenario.text);
    const SimulatedScenario alone = read_simulated_scenario(place / "scenarios/alone.yaml");
    const Recording recording = run_experiment(alone);
    const Verdict verdict = judge(recording, alone.robot.robot->space(), alone.expected, alone.force_limits);
    EXPECT_EQ(csv_row(result_of(run, verdict)), csv_row(whole[number]));
  }
}

TEST(ACampaignOverEstimators, GivesWhateverIsFollowedTheBitsOfARun) {
  const test::Workplace place;
  test::small_campaign(place, 1);
  std::string followed;
  for (const WrenchEstimator& stage : estimator_stages()) followed += ", [" + stage.name + "]";
  place.replace("campaigns/small.yaml", "contact: {body: [platform, link2]}", "contact: {body: [link2]}");
  place.replace("campaigns/small.yaml",
                "control.momentum_observer.gain_per_s, values: [[20, 20, 20], [40, 40, 40]]",
                "control.estimators, values: [" + followed.substr(2) + "]");
  const Campaign campaign =
      read_campaign(place / "campaigns/small.yaml", {.set = {"control.accelerations=[extended_imu_ekf]"}});
  ASSERT_EQ(campaign.runs(), estimator_stages().size());
  std::set<double> errors;
  std::filesystem::create_directories(place / "out");
  for (const RunResult& result : run_campaign(campaign, place / "out", 2)) {
    const CampaignRun run = draw_run(campaign, result.run);
    place.write("scenarios/alone.yaml", run.scenario.text);
    const SimulatedScenario alone = read_simulated_scenario(place / "scenarios/alone.yaml");
    const Verdict verdict =
        judge(run_experiment(alone), alone.robot.robot->space(), alone.expected, alone.force_limits);
    EXPECT_EQ(csv_row(result_of(run, verdict)), csv_row(result)) << result.values.front().second;
    errors.insert(result.observer_error_force);
  }
  EXPECT_EQ(errors.size(), campaign.runs()) << "each has an error of its own";
}

/// What a task says of its numbers stands in the table as if they were runs.
TEST_F(ACampaign, DoesATaskInThePlaceOfRuns) {
  const RunResult row = whole[1];
  campaign.task = CampaignTask{"task", 5, [row](std::size_t number) {
                                 RunResult result = row;
                                 result.run = number;
                                 result.peak_force = 100.0 + static_cast<double>(number);
                                 return result;
                               }};
  const CampaignResults results = run_campaign(campaign, place / "other", 3);
  ASSERT_EQ(results.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(results[i].peak_force, 100.0 + static_cast<double>(i));
  campaign.task->identity = "another task";
  EXPECT_FALSE(test::problems_of([&] { run_campaign(campaign, place / "other", 1); }).empty());
}

TEST_F(ACampaign, RunsBodiesIntoThePylon) {
  std::size_t as_drawn = 0;
  for (const RunResult& result : whole) {
    EXPECT_NE(result.body, "none");
    for (const auto& [key, value] : result.values) {
      if (key != "contact") continue;
      if (value.ends_with(result.body)) ++as_drawn;
      EXPECT_TRUE(value.ends_with(result.meant)) << result.meant << " is expected, not " << value;
    }
  }
  EXPECT_GE(as_drawn, whole.size() - 2) << "of " << whole.size();
}

}  // namespace
}  // namespace flinch
