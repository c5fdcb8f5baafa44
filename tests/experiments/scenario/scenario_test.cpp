#include "experiments/scenario/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/simulated/experiment.h"
#include "systems/config/robot_file.h"
#include "systems/framework/diagram.h"
#include "systems/framework/recording.h"
#include "systems/robot/planar_rrr.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::shipped;
using ::testing::Contains;
using ::testing::ElementsAre;

/// The least that a scenario can say.
constexpr const char* least = "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.25\n";

Scenario scenario_of(const test::Workplace& place, const std::string& text) {
  place.write("scenarios/own.yaml", text);
  return read_scenario(place / "scenarios/own.yaml");
}

const PlanarRrrParameters& believed(const Scenario& scenario) {
  return dynamic_cast<const PlanarRrr&>(*scenario.robot.robot).parameters();
}

TEST(ShippedScenarios, AreThoseOfThePapers) {
  EXPECT_THAT(test::shipped_scenarios(), ElementsAre("clamping", "first_link_collision", "platform_collision",
                                                     "second_link_collision", "square", "stiffness"));
}

TEST(ShippedScenarios, AreAllGood) {
  for (const std::string& name : test::shipped_scenarios()) {
    const Scenario scenario = read_scenario(shipped("scenarios/" + name + ".yaml"));
    EXPECT_EQ(scenario.name, name);
    EXPECT_FALSE(scenario.title.empty() || scenario.description.empty()) << name;
    EXPECT_NE(build_experiment(scenario).diagram, nullptr);
  }
}

TEST(Scenario, NeedsNoMoreThanARobotAndADuration) {
  const test::Workplace place;
  const Scenario scenario = scenario_of(place, least);
  EXPECT_EQ(scenario.name, "own");
  EXPECT_EQ(scenario.title, "own");
  EXPECT_EQ(scenario.seed, 1U);
  EXPECT_EQ(scenario.duration, 250ms);
  EXPECT_FALSE(scenario.control.trajectory.path.has_value());
  EXPECT_FALSE(scenario.station.bench.pylon.has_value());
  EXPECT_TRUE(scenario.station.applied_wrench.empty());
  EXPECT_FALSE(scenario.expected.contact.has_value());
  EXPECT_EQ(run_experiment(scenario).samples(), 250U);
}

TEST(Scenario, HasTheDefaultsOfThePapers) {
  const test::Workplace place;
  const Scenario scenario = scenario_of(place, least);
  const ContactControlSettings& control = scenario.control;
  EXPECT_EQ(control.momentum_observer.gain, PlatformVector::Constant(3, 20.0));
  EXPECT_EQ(control.contact_detector.reaction.force, 10.0);
  EXPECT_EQ(control.contact_detector.reaction.moment, 1.0);
  EXPECT_EQ(control.impedance.stiffness, PlatformVector(Eigen::Vector3d(2000.0, 2000.0, 85.0)));
  EXPECT_EQ(control.retraction.distance, 0.1);
  EXPECT_EQ(scenario.force_limits.transient, 280.0);
  EXPECT_EQ(scenario.force_limits.quasi_static, 140.0);
}

TEST(Scenario, SimulatesTheRobotThatTheControllerBelievesIn) {
  const test::Workplace place;
  const Scenario scenario = scenario_of(place, least);
  EXPECT_EQ(scenario.station.bench.robot.platform_mass, believed(scenario).platform_mass);
  EXPECT_EQ(scenario.station.bench.robot.legs[1].active_friction.coulomb,
            believed(scenario).legs[1].active_friction.coulomb);
  EXPECT_EQ(scenario.control.faults.workspace.max_distance, scenario.robot.limits.max_distance);
}

TEST(Scenario, CanLetThePlantDifferFromTheModel) {
  const test::Workplace place;
  const Scenario scenario = scenario_of(
      place, std::string(least) + "plant: {friction: none, payload_kg: 0.5, leg_inertia_scale: 1.1}\n");
  const PlanarRrrParameters& plant = scenario.station.bench.robot;
  EXPECT_EQ(plant.platform_mass, believed(scenario).platform_mass + 0.5);
  EXPECT_EQ(plant.legs[2].inertia.p1, believed(scenario).legs[2].inertia.p1 * 1.1);
  EXPECT_EQ(plant.legs[0].active_friction.coulomb, 0.0);
  EXPECT_GT(believed(scenario).legs[0].active_friction.coulomb, 0.0);
}

TEST(Scenario, StartsWhereItsMotionStarts) {
  for (const std::string& name : test::shipped_scenarios()) {
    const Scenario scenario = read_scenario(shipped("scenarios/" + name + ".yaml"));
    const auto& path = scenario.control.trajectory.path;
    const auto& start = scenario.station.bench.initial_pose;
    ASSERT_EQ(start.has_value(), path.has_value()) << name;
    if (path) {
      EXPECT_EQ(PlatformVector(*start), path->start()) << name;
    }
  }
}

TEST(Scenario, TakesTheSeedOfTheCommandLine) {
  const std::filesystem::path file = shipped("scenarios/square.yaml");
  EXPECT_EQ(read_scenario(file).seed, 1U);
  EXPECT_EQ(read_scenario(file).station.seed, 1U);
  EXPECT_EQ(read_scenario(file, 18446744073709551615U).seed, 18446744073709551615U);
  EXPECT_EQ(read_scenario(file, 7).station.seed, 7U);
}

TEST(Scenario, ListsEveryParameterWithItsOrigin) {
  const Scenario scenario = read_scenario(shipped("scenarios/platform_collision.yaml"));
  const auto is = [](const std::string& key, const std::string& value, bool from_file) {
    return ::testing::AllOf(::testing::Field(&ReadValue::key, key),
                            ::testing::Field(&ReadValue::value, value),
                            ::testing::Field(&ReadValue::from_file, from_file));
  };
  EXPECT_THAT(scenario.values, Contains(is("motion.cruise", "0.08", true)));
  EXPECT_THAT(scenario.values, Contains(is("control.momentum_observer.gain", "[20, 20, 20]", true)));
  EXPECT_THAT(scenario.values, Contains(is("control.contact_detector.hard_force", "60", false)));
  EXPECT_THAT(scenario.values, Contains(is("plant.friction", "as_robot_file", false)));
}

TEST(Scenario, ComesBackOutOfItsRecording) {
  test::Workplace place;
  place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.05");
  const Scenario scenario = read_scenario(place / "scenarios/platform_collision.yaml", 42);
  const Scenario again = recorded_scenario(run_experiment(scenario), "run.h5");
  EXPECT_EQ(again.name, scenario.name);
  EXPECT_EQ(again.seed, 42U);
  EXPECT_EQ(again.text, scenario.text);
  EXPECT_EQ(again.robot_text, scenario.robot_text);
  EXPECT_EQ(again.expected.contact, scenario.expected.contact);
  EXPECT_EQ(again.station.bench.initial_pose, scenario.station.bench.initial_pose);
}

}  // namespace
}  // namespace flinch
