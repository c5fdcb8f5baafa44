#include "experiments/scenario/scenario_isolation.h"

#include <gmock/gmock.h>

#include "diagrams/isolation_settings.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using testing::HasSubstr;

IsolationSettings read(const std::string& text) {
  IsolationSettings settings;
  ConfigReader reader = ConfigReader::parse(text, "scenario.yaml");
  read_isolation(reader.section("isolation"), {DriveKind::revolute, 3}, settings);
  reader.finish();
  return settings;
}

TEST(ReadIsolation, TakesWhatTheFileSaysAndLeavesTheRest) {
  const IsolationSettings settings = read(
      "isolation: {observer_gain_per_s: 200, force_deviation_N: 1.5, accept: 0.8, largest_residual: 20, "
      "window_ms: 5, leaning: "
      "0.2, "
      "particles: 200, object_speed_m_per_s: 0.1, decision_tree: {right_of_link1: 0.7}}");
  EXPECT_EQ(settings.observer_gain, 200.0);
  EXPECT_EQ(settings.uncertainty.force, 1.5);
  EXPECT_EQ(settings.uncertainty.moment, IsolationSettings().uncertainty.moment);
  EXPECT_EQ(settings.model_classifier.accept, 0.8);
  EXPECT_EQ(settings.decision_tree.accept, 0.8);
  EXPECT_EQ(settings.decision_tree.right_of_link1, 0.7);
  EXPECT_EQ(settings.decision_tree.right_of_link2, DecisionTreeSettings().right_of_link2);
  EXPECT_EQ(settings.model_classifier.largest_residual, 20.0);
  EXPECT_EQ(settings.model_classifier.window, 5ms);
  EXPECT_EQ(settings.closed_form.leaning, 0.2);
  EXPECT_EQ(settings.particle_filter.leaning, 0.2);
  EXPECT_EQ(read("isolation: {leaning: 0}").particle_filter.leaning, 0.0);
  EXPECT_EQ(settings.particle_filter.particles, 200);
  EXPECT_EQ(settings.hypotheses.object_speed, 0.1);
}

TEST(ReadIsolation, TakesADeviationForEachDriveOrOneForAll) {
  EXPECT_EQ(read("isolation: {drive_deviation_Nm: [1, 2, 3]}").uncertainty.drive_torque,
            Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(read("isolation: {drive_deviation_Nm: 2}").uncertainty.drive_torque,
            Eigen::Vector3d::Constant(2.0));
  EXPECT_EQ(read("isolation: {}").uncertainty.drive_torque.size(), 0);
  EXPECT_THROW(read("isolation: {drive_deviation_Nm: [1, 2]}"), SetupError);
  EXPECT_THROW(read("isolation: {drive_deviation_Nm: [1, 0, 1]}"), SetupError);
  EXPECT_THROW(read("isolation: {drive_deviation_N: 1}"), SetupError) << "these drives turn";
}

TEST(ReadIsolation, TakesAShareOfRightAnswersOfTheTreeForEachThatItNames) {
  const DecisionTreeSettings tree =
      read(
          "isolation: {decision_tree: {right_of_platform: 0.1, right_of_link1: 0.2, right_of_link2: 0.3, "
          "right_of_clamping: 0.4}}")
          .decision_tree;
  EXPECT_EQ(tree.right_of_platform, 0.1);
  EXPECT_EQ(tree.right_of_link1, 0.2);
  EXPECT_EQ(tree.right_of_link2, 0.3);
  EXPECT_EQ(tree.right_of_clamping, 0.4);
}

TEST(ReadIsolation, TakesFilesOfNetworksFromTheScenarioOn) {
  IsolationSettings settings = read(
      "isolation: {papers_networks: {body: ../body.onnx, chain: /far/chain.onnx, accept: 0.7}, "
      "learned_classifier: {network: bodies.onnx}}");
  find_networks("some/where", settings);
  EXPECT_EQ(settings.papers_networks.body, "some/body.onnx");
  EXPECT_EQ(settings.papers_networks.chain, "/far/chain.onnx");
  EXPECT_EQ(settings.papers_networks.clamping, "") << "that comes with flinch";
  EXPECT_EQ(settings.papers_networks.accept, 0.7);
  EXPECT_EQ(settings.learned_network, "some/where/bodies.onnx");
}

TEST(ReadIsolation, TakesForceSensorsBelowTheBaseJointsWhereTheyAreNamed) {
  EXPECT_FALSE(read("isolation: {}").base_forces);
  const auto found =
      read("isolation: {base_forces: {first_moment_kg_m: [1, 2, 3], deviation_N: 2, period_ms: 10}}")
          .base_forces;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first_moment, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(found->pairs.base_force, 2.0);
  EXPECT_EQ(found->period, 10ms);
  EXPECT_THROW(read("isolation: {base_forces: {deviation_N: 2}}"), SetupError) << "first_moment is needed";
  EXPECT_THROW(read("isolation: {base_forces: {first_moment_kg_m: [1, -2, 3]}}"), SetupError);
}

TEST(ReadIsolation, RefusesWhatCannotBe) {
  try {
    read(
        "isolation: {accept: 1.5, largest_residual: 0, particles: 100000, observer_gain_per_s: 0, "
        "decision_tree: {right_of_platform: 1.1, right_of_link1: -0.1}}");
    FAIL() << "was taken";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 6u);
  }
}

}  // namespace
}  // namespace flinch
