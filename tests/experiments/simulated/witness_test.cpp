// What a verdict rests on where nobody knows the truth: a simulated run judged with the truth, and without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/report/experiment_report.h"
#include "experiments/report/report.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/framework/recording.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

struct SimulatedRun {
  SimulatedScenario scenario = read_simulated_scenario(test::shipped("scenarios/platform_collision.yaml"));
  Recording recording = run_experiment(scenario);

  void forget(const std::string& path) {
    std::erase_if(recording.signals, [&path](const Signal& signal) { return signal.path == path; });
  }
  Verdict judged() const {
    return judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  }
};

TEST(Witness, IsTheForceTorqueSensorWhereNobodyKnowsTheTruth) {
  SimulatedRun run;
  const Verdict truth = run.judged();
  run.forget("truth");
  run.forget("contact");
  const Verdict measured = run.judged();
  EXPECT_EQ(measured.witness, Witness::force_torque);
  ASSERT_EQ(measured.contacts.size(), 1U);
  const ContactVerdict &seen = measured.contacts[0], &happened = truth.contacts[0];
  EXPECT_EQ(seen.body, "");
  EXPECT_NEAR(seen.onset, happened.onset, 1e-3);
  EXPECT_EQ(seen.detected, happened.detected);
  EXPECT_NEAR(seen.peak_force, happened.peak_force, 5.0);
  EXPECT_NEAR(seen.speed, happened.speed, 0.05);
  EXPECT_EQ(measured.false_detections, 0);
  EXPECT_FALSE(measured.loop_closure.has_value());
  EXPECT_TRUE(measured.good()) << measured.failures.front();
  EXPECT_NO_THROW(check_report(experiment_report(run.scenario, run.recording, measured)));
}

TEST(Witness, ThatDoesNotSeeTheBodyLeavesItToWhatWasExpected) {
  SimulatedRun run;
  run.scenario.expected.contact = "leg2_link2";
  run.forget("truth");
  run.forget("contact");
  EXPECT_THAT(run.judged().remarks,
              testing::ElementsAre(testing::HasSubstr("leg2_link2 was taken for one with platform")));
}

TEST(Witness, DoesNotTakeAMissingMeasurementForAForceOfZero) {
  SimulatedRun run;
  run.forget("truth");
  run.forget("contact");
  const double onset = run.judged().contacts.at(0).onset;
  const auto sensor = std::find_if(run.recording.signals.begin(), run.recording.signals.end(),
                                   [](const Signal& signal) { return signal.path == "force_torque"; });
  const std::vector<double> valid = run.recording.column("force_torque", "valid");
  const std::size_t numbers = sensor->layout.numbers;
  const auto before = static_cast<std::size_t>(std::floor(1e3 * onset));
  std::size_t flag = 0;  // the column of `valid`: the one that holds 1 where the first reading is valid
  for (const Field& field : sensor->layout.fields) {
    if (field.name == "valid") break;
    flag += static_cast<std::size_t>(field.capacity);
  }
  ASSERT_EQ(valid.at(before), 1.0);
  sensor->rows.at(before * numbers + flag) = {};
  ASSERT_EQ(run.recording.column("force_torque", "valid").at(before), 0.0);

  const Verdict judged = run.judged();
  ASSERT_EQ(judged.contacts.size(), 1U);
  EXPECT_FALSE(std::isnan(judged.contacts[0].onset));
  EXPECT_NEAR(judged.contacts[0].onset, onset, 2e-3);
  EXPECT_FALSE(judged.contacts[0].lasting_force.has_value());
}

TEST(Witness, IsNobodyWithoutThatSensor) {
  SimulatedRun run;
  run.forget("truth");
  run.forget("contact");
  run.forget("force_torque");
  const Verdict verdict = run.judged();
  EXPECT_EQ(verdict.witness, Witness::none);
  EXPECT_THAT(verdict.contacts, testing::IsEmpty());
  EXPECT_THAT(verdict.detections, testing::SizeIs(1));
  EXPECT_TRUE(verdict.good()) << verdict.failures.front();
  EXPECT_NO_THROW(check_report(experiment_report(run.scenario, run.recording, verdict)));
}

}  // namespace
}  // namespace flinch
