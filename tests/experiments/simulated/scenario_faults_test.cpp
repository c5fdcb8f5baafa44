#include "experiments/simulated/scenario_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/recorded/replay.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

SimulatedScenario scenario_with(const test::Workplace& place, const std::string& faults) {
  place.write("scenarios/own.yaml", "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.4\nfaults:\n" + faults);
  return read_simulated_scenario(place / "scenarios/own.yaml");
}

std::vector<std::string> problems_with(const std::string& faults) {
  const test::Workplace place;
  try {
    scenario_with(place, faults);
  } catch (const SetupError& error) {
    return error.problems();
  }
  return {};
}

TEST(ScenarioFaults, AreReadInTheWordsOfTheCommandLine) {
  const test::Workplace place;
  const SimulatedScenario scenario =
      scenario_with(place,
                    "  - {signal: encoder2, kind: drifting, time_s: 0.1, size: -5}\n"
                    "  - {signal: brakes, kind: delayed, time_ms: 0, size: 0.03}\n");
  std::vector<std::string> texts;
  for (const RequestedFault& fault : scenario.station.faults) texts.push_back(text_of(fault));
  EXPECT_THAT(texts, ElementsAre("encoder2:drifting@0.1:-5", "brakes:delayed@0:0.03"));
}

TEST(ScenarioFaults, AreToldWithTheirPlaceWhereTheyCannotBe) {
  EXPECT_THAT(problems_with("  - {signal: encoder4, kind: off, time_s: 0.1}\n"),
              ElementsAre(testing::AllOf(HasSubstr("own.yaml:4"), HasSubstr("the numbers are 1 to 3"))));
  EXPECT_THAT(problems_with("  - {signal: drive1, kind: offf, time_s: 0.1}\n"),
              ElementsAre(HasSubstr("did you mean 'off'?")));
  EXPECT_THAT(problems_with("  - {signal: drive1, kind: off}\n"), Contains(HasSubstr("time")));
  const std::string words = "off, stuck, noise, wrong, drifting, scaled, delayed";
  EXPECT_THAT(problems_with("  - {signal: drive1, kind: broken, time_s: 0.1}\n"),
              ElementsAre(testing::AllOf(HasSubstr("faults[0].kind: is 'broken'"), HasSubstr(words))));
  EXPECT_THAT(problems_with("  - {signal: drive1, time_s: 0.1}\n"),
              ElementsAre(testing::AllOf(HasSubstr("faults[0].kind: is missing"), HasSubstr(words))));
}

TEST(ScenarioFaults, SpoilWhatTheControlPathIsToldAndWhatIsRecorded) {
  const test::Workplace place;
  const Recording spoilt = run_experiment(
      scenario_with(place, "  - {signal: passive_encoder1, kind: wrong, time_s: 0.1, size: 0.5}\n"));
  EXPECT_EQ(spoilt.attributes.at("faults"), "passive_encoder1:wrong@0.1:0.5");
  const std::vector<double> passive = spoilt.column("joints", "passive", 0);
  EXPECT_NEAR(passive[100] - passive[99], 0.5, 0.01);
}

TEST(ScenarioFaults, CanBePutOnTopOfARecordingButForThoseOfWhatMoves) {
  const test::Workplace place;
  place.write("scenarios/own.yaml", "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.4\n");
  const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/own.yaml");
  const Recording healthy = run_experiment(scenario);
  const ParallelRobot& robot = *scenario.robot.robot;
  const Replay replayed = replay(scenario, healthy, {}, {}, {parse_fault("currents:wrong@0.35:2", robot)});
  EXPECT_THAT(replayed.differing, Contains("drives"));
  EXPECT_NEAR(
      replayed.recording.column("drives", "current", 1)[360] - healthy.column("drives", "current", 1)[360],
      2.0, 1e-12);
  EXPECT_THROW(replay(scenario, healthy, {}, {}, {parse_fault("drives:off@0.1", robot)}), SetupError);
  EXPECT_THROW(replay(scenario, healthy, {}, {}, {parse_fault("imu:off@0.4", robot)}), SetupError);
}

TEST(ScenarioFaults, ThatWouldNeverShowAreRefused) {
  const test::Workplace place;
  const auto build = [&](const char* fault) { build_experiment(scenario_with(place, fault)); };
  EXPECT_NO_THROW(build("  - {signal: imu, kind: off, time_s: 0.39}\n"));
  EXPECT_THROW(build("  - {signal: imu, kind: off, time_s: 0.4}\n"), SetupError);
  EXPECT_THROW(build("  - {signal: force_torque, kind: off, time_s: 0.1}\n"), SetupError);
}

}  // namespace
}  // namespace flinch
