#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/report/experiment_report.h"
#include "experiments/report/report.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "experiments/verdict/verdict_output.h"
#include "systems/framework/recording.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using testing::ElementsAre;

/// The shipped collision with the platform with these lines more in `control`.
Verdict collision(const std::string& control) {
  const test::Workplace place;
  place.replace("scenarios/platform_collision.yaml", "control:\n", "control:\n" + control);
  const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/platform_collision.yaml");
  return judge(run_experiment(scenario), scenario.robot.robot->space(), scenario.expected, {});
}

std::vector<std::string> names(const ContactVerdict& contact) {
  std::vector<std::string> names;
  for (const DetectionBy& by : contact.detected_by) names.push_back(by.estimator);
  return names;
}

TEST(EstimatorsSideBySide, AreEachFollowedByADetectorForTheVerdict) {
  const Verdict together = collision("  estimators: [momentum_observer, momentum_kalman_filter]\n");
  const ContactVerdict& contact = together.contacts.at(0);
  ASSERT_THAT(names(contact), ElementsAre("momentum_observer", "momentum_kalman_filter"));
  EXPECT_EQ(contact.detected_by[0].detected, contact.detected);

  const Verdict alone = collision("  estimators: [momentum_kalman_filter]\n");
  ASSERT_THAT(names(alone.contacts.at(0)), ElementsAre("momentum_kalman_filter"));
  // The same but for noise: alone it settles earlier, and the motion begins a little earlier.
  EXPECT_NEAR(*alone.contacts[0].detected - alone.contacts[0].onset,
              *contact.detected_by[1].detected - contact.onset, 1.1e-3);
}

TEST(EstimatorsSideBySide, AreToldByNameWhicheverIsFollowed) {
  const Verdict verdict = collision(
      "  estimators: [momentum_observer, momentum_kalman_filter]\n"
      "  follow: {estimator: momentum_kalman_filter}\n");
  const ContactVerdict& contact = verdict.contacts.at(0);
  ASSERT_THAT(names(contact), ElementsAre("momentum_kalman_filter", "momentum_observer"));
  const nlohmann::json told = nlohmann::json::parse(verdict_json(verdict, {}));
  const nlohmann::json& first = told["contacts"][0];
  EXPECT_EQ(first["detection_by_estimator_ms"]["momentum_kalman_filter"], first["detection_ms"]);
  EXPECT_GT(first["detection_by_estimator_ms"]["momentum_observer"], first["detection_ms"]);
  EXPECT_THAT(verdict_table(verdict, {}), testing::HasSubstr("by momentum_observer"));
}

TEST(EstimatorsSideBySide, ThatNeverNoticeAreToldAsNever) {
  const Verdict verdict = collision(
      "  estimators: [momentum_observer, momentum_kalman_filter]\n"
      "  momentum_kalman_filter: {force_density_N2_per_s: 1.0e-6, moment_density_N2m2_per_s: 1.0e-8}\n");
  const nlohmann::json told = nlohmann::json::parse(verdict_json(verdict, {}));
  EXPECT_TRUE(told["contacts"][0]["detection_by_estimator_ms"]["momentum_kalman_filter"].is_null());
}

TEST(EstimatorsSideBySide, StandOnThePageOverTheTruth) {
  const test::Workplace place;
  place.replace("scenarios/platform_collision.yaml", "control:\n",
                "control:\n  estimators: [momentum_observer, momentum_kalman_filter]\n");
  const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/platform_collision.yaml");
  const Recording recording = run_experiment(scenario);
  const Verdict verdict = judge(recording, scenario.robot.robot->space(), scenario.expected, {});
  const Report report = experiment_report(scenario, recording, verdict);
  EXPECT_NO_THROW(check_report(report));
  EXPECT_THAT(report.estimators, ElementsAre("momentum_observer", "momentum_kalman_filter"));
  const auto x = recording.column("wrench_momentum_kalman_filter", "wrench_in_base", 0);
  const auto y = recording.column("wrench_momentum_kalman_filter", "wrench_in_base", 1);
  const auto force = report.columns.at("estimator_2_force");
  const auto sample = static_cast<std::size_t>(1e3 * *verdict.contacts.at(0).detected) + 10;
  EXPECT_GT(force.at(sample), 5.0);
  EXPECT_NEAR(force.at(sample), std::hypot(x.at(sample), y.at(sample)), 1e-12);
  ASSERT_EQ(report.contacts.at(0).detected_by.size(), 2U);
  EXPECT_EQ(report.contacts[0].detected_by[1].first, "momentum_kalman_filter");
  EXPECT_EQ(report.contacts[0].detected_by[1].second, verdict.contacts[0].detected_by[1].detected);
}

}  // namespace
}  // namespace flinch
