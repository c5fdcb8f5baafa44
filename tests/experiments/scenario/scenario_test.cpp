#include "experiments/scenario/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagrams/robot_settings.h"
#include "systems/config/config_reader.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::shipped;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// The least that a scenario can say.
constexpr const char* least = "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.25\n";

Scenario scenario_of(const test::Workplace& place, const std::string& text) {
  place.write("scenarios/own.yaml", text);
  return read_scenario(place / "scenarios/own.yaml");
}

std::vector<std::string> problems_with(const test::Workplace& place, const std::string& text) {
  return test::problems_of([&] { scenario_of(place, text); });
}

TEST(Scenario, NeedsNoMoreThanARobotAndADuration) {
  const test::Workplace place;
  const Scenario scenario = scenario_of(place, least);
  EXPECT_EQ(scenario.name, "own");
  EXPECT_EQ(scenario.title, "own");
  EXPECT_EQ(scenario.seed, 1U);
  EXPECT_EQ(scenario.duration, 250ms);
  EXPECT_FALSE(scenario.control.trajectory.path.has_value());
  EXPECT_TRUE(scenario.obstacles.empty());
  EXPECT_FALSE(scenario.expected.contact.has_value());
}

TEST(Scenario, MayNotAskAnEstimatorForMoreThanALoopCanDo) {
  const test::Workplace place;
  const std::vector<std::pair<std::string, std::string>> rates = {{"momentum_observer", "gain_per_s"},
                                                                  {"sliding_mode_observer", "damping_per_s"},
                                                                  {"disturbance_filter", "pole_per_s"},
                                                                  {"imu_residual", "gyroscope_gain_per_s"}};
  const std::vector<std::pair<std::string, std::string>> sizes = {
      {"momentum_kalman_filter", "force_density_N2_per_s"}, {"sliding_mode_observer", "force_rate_N_per_s"},
      {"imu_ekf", "gyroscope_deviation_rad_per_s"},         {"extended_imu_ekf", "position_deviation_m"},
      {"imu_residual", "accelerometer_deviation_m_per_s2"}, {"disturbance_filter", "encoder_deviation_rad"}};
  const auto problems_of_value = [&](const auto& key, const std::string& value) {
    const std::string written = key.first == "momentum_observer" ? "[20, " + value + ", 20]" : value;
    return problems_with(
        place, std::string(least) + "control: {" + key.first + ": {" + key.second + ": " + written + "}}\n");
  };
  for (const auto& key : rates) {
    for (const char* const value : {"1e300", "1.1e4", "1e-4"})
      EXPECT_THAT(problems_of_value(key, value), ElementsAre(HasSubstr(key.second))) << key.second << value;
    EXPECT_THAT(problems_of_value(key, "3e3"), IsEmpty()) << key.second;
  }
  for (const auto& key : sizes) {
    for (const char* const value : {"1e300", "1e13", "1e-13"})
      EXPECT_THAT(problems_of_value(key, value), ElementsAre(HasSubstr(key.second))) << key.second << value;
  }
}

TEST(Scenario, ChoosesStages) {
  const test::Workplace place;
  place.write("scenarios/own.yaml", std::string(least) +
                                        "control:\n  estimators: [momentum_observer, own]\n"
                                        "  follow: {estimator: own}\n");
  ControlStages known = standard_stages();
  known.estimators.add({"unused", known.estimators.all[0].add});
  known.estimators.add({"own", known.estimators.all[0].add});
  const Scenario scenario =
      read_scenario(place / "scenarios/own.yaml", std::nullopt, leave_simulation_unread, known);
  const auto& estimators = scenario.control.stages.estimators;
  ASSERT_EQ(estimators.all.size(), 2U);
  EXPECT_EQ(estimators.all[1].name, "own");
  EXPECT_EQ(estimators.followed, "own");
  EXPECT_EQ(scenario.control.stages.detectors.all.size(), 1U);
}

TEST(Scenario, TellsTheNearestNameOfAStage) {
  const test::Workplace place;
  EXPECT_THAT(
      problems_with(place, std::string(least) + "control:\n  estimators: [momentum_observers]\n"
                                                "  follow: {detector: contact_detecter}\n"),
      ElementsAre(HasSubstr("own.yaml:4: control.estimators[0]: is 'momentum_observers'; did you mean "
                            "'momentum_observer'?"),
                  HasSubstr("own.yaml:5: control.follow.detector: is 'contact_detecter', which is not "
                            "among detectors; did you mean 'contact_detector'?")));
}

TEST(Scenario, BeginsWithTheSettingsOfItsRobotAsCppDoes) {
  const test::Workplace place;
  const Scenario scenario = scenario_of(place, least);
  const RobotFile& file = scenario.robot;
  const ContactControlSettings own = settings_for(*file.robot, file.drives, file.limits);
  const ContactControlSettings& read = scenario.control;
  EXPECT_EQ(read.drive_torque.torque_constant, own.drive_torque.torque_constant);
  EXPECT_EQ(read.aligned_with_velocity, own.aligned_with_velocity);
  EXPECT_EQ(read.faults.max_joint_speed, own.faults.max_joint_speed);
  EXPECT_EQ(read.faults.max_unseen_current, own.faults.max_unseen_current);
  EXPECT_EQ(read.torque_gate.max_torque, own.torque_gate.max_torque);
  EXPECT_EQ(read.controlled_stop.damping, own.controlled_stop.damping);
  EXPECT_EQ(read.sequence.rest_speed, own.sequence.rest_speed);
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
  EXPECT_EQ(control.faults.workspace.max_distance, scenario.robot.limits.max_distance);
  EXPECT_EQ(scenario.force_limits.transient, 280.0);
  EXPECT_EQ(scenario.force_limits.quasi_static, 140.0);
}

// It leaves all limits to what `limits` keeps.
TEST(Scenario, OfTheStrictReactionKeepsLimits) {
  const test::Workplace place;
  const auto with = [](const std::string& control) {
    return std::string(least) + "control: {" + control + "}\n";
  };
  const ContactControlSettings strict = scenario_of(place, with("reaction_laws: [strict_reaction]")).control;
  EXPECT_EQ(strict.limits.use, SafetyFilterSettings::Use::always);
  EXPECT_EQ(strict.limits.limits.max_condition_number, strict.tasks.constraints.sigma_kappa.safety);
  EXPECT_LT(strict.limits.max_platform_speed, 3.0);
  EXPECT_THAT(problems_with(place, with("reaction_laws: [strict_reaction], limits: {keep: never}")),
              ElementsAre(HasSubstr("own.yaml:3: control.limits.keep: is 'never', but strict_reaction")));
  EXPECT_THAT(problems_with(place, with("reaction_laws: [strict_reaction], limits: {keep: after_contact}")),
              IsEmpty());
  EXPECT_THAT(problems_with(place, with("reaction_laws: [torque_reaction], limits: {keep: never}")),
              IsEmpty());
}

// A law that runs for comparison acts on nothing.
TEST(Scenario, KeepsTheLimitsOfTheReactionThatIsFollowed) {
  const test::Workplace place;
  const auto limits_with = [&place](const std::string& follow) {
    return scenario_of(place, std::string(least) +
                                  "control: {reaction_laws: [torque_reaction, strict_reaction]" + follow +
                                  "}\n")
        .control.limits.use;
  };
  EXPECT_EQ(limits_with(""), SafetyFilterSettings::Use::after_contact);
  EXPECT_EQ(limits_with(", follow: {reaction_law: strict_reaction}"), SafetyFilterSettings::Use::always);
}

TEST(Scenario, SaysWhereTheForceLimitsAreFrom) {
  const test::Workplace place;
  const std::string legs = std::string(least) + "force_limits: {region: lower_leg";
  const ForceLimits leg = scenario_of(place, legs + "}\n").force_limits;
  EXPECT_EQ(leg.transient, 260.0);
  EXPECT_THAT(leg.transient_source, HasSubstr("twice the quasi-static force"));
  EXPECT_THAT(leg.quasi_static_source, HasSubstr("Table A.2"));

  const ForceLimits own = scenario_of(place, legs + ", transient_N: 100}\n").force_limits;
  EXPECT_EQ(own.region, "lower_leg");
  EXPECT_EQ(own.transient_source, "set by the scenario");
  EXPECT_EQ(own.quasi_static_source, leg.quasi_static_source);

  const ForceLimits same = scenario_of(place, legs + ", transient_N: 260}\n").force_limits;
  EXPECT_EQ(same.transient_source, leg.transient_source) << "it is that number";
}

TEST(Scenario, SaysWhatARobotMayDoThatIsBroughtBack) {
  const test::Workplace place;
  const Scenario scenario =
      scenario_of(place, std::string(least) +
                             "control: {recovery: {speed_share: 0.1, torque_share: 0.2, margin_share: 0.03, "
                             "over_after_ms: 50, limits: {velocity_m_per_s: 0.02}}}\n");
  const ContactControlSettings& control = scenario.control;
  EXPECT_EQ(control.faults.recovery_speed, 0.1);
  EXPECT_EQ(control.torque_gate.recovery_torque, 0.2);
  EXPECT_EQ(control.faults.recovery_margin, 0.03);
  EXPECT_EQ(control.torque_gate.recovered_after, 50ms);
  EXPECT_EQ(control.trajectory.recovery.translation.velocity, 0.02);
  EXPECT_EQ(control.trajectory.recovery.rotation.velocity, 0.15);
  EXPECT_THAT(problems_with(place, std::string(least) + "control: {recovery: {speed_share: 1.5}}\n"),
              ElementsAre(HasSubstr("own.yaml:3: control.recovery.speed_share: is 1.5")));
}

TEST(Scenario, ChecksTheRestByARobotOfTheKindThatIsNoGood) {
  const test::Workplace place;
  place.replace("robots/hexapod_6ups.yaml", "characteristic_length_m: 0.25", "characteristic_length_m: -1");
  const auto problems = problems_with(place,
                                      "robot: ../robots/hexapod_6ups.yaml\nduration_s: 0.25\nseed: one\n"
                                      "motion: {kind: through, poses: [{x_m: 0, y_m: 0, z_m: 0.62}]}\n"
                                      "control: {drive_torque: {force_constant_N_per_A: 100}}\n");
  EXPECT_THAT(problems, Contains(HasSubstr("characteristic_length_m: is -1 m")));
  EXPECT_THAT(problems, Contains(HasSubstr("own.yaml:3: seed: is 'one'")));
  EXPECT_THAT(problems, Each(Not(HasSubstr("not a known key"))));
}

TEST(Scenario, SaysNothingOfTheRestWhereTheKindIsNotKnown) {
  const test::Workplace place;
  place.replace("robots/hexapod_6ups.yaml", "kind: hexapod_6ups", "kind: hexapod");
  const auto problems = problems_with(place,
                                      "robot: ../robots/hexapod_6ups.yaml\nduration_s: 0.25\n"
                                      "motion: {kind: through, poses: [{x_m: 0, y_m: 0, z_m: 0.62}]}\n");
  EXPECT_THAT(problems, Contains(HasSubstr("kind: is 'hexapod'")));
  EXPECT_THAT(problems, Each(Not(HasSubstr("own.yaml"))));
}

TEST(Scenario, TakesTheSeedOfTheCommandLine) {
  const std::filesystem::path file = shipped("scenarios/square.yaml");
  EXPECT_EQ(read_scenario(file).seed, 1U);
  EXPECT_EQ(read_scenario(file, 18446744073709551615U).seed, 18446744073709551615U);
}

TEST(Scenario, KnowsWhatCanBeRunInto) {
  const Scenario scenario = read_scenario(shipped("scenarios/platform_collision.yaml"));
  ASSERT_EQ(scenario.obstacles.size(), 1U);
  EXPECT_EQ(scenario.obstacles[0].name, "pylon");
  EXPECT_NEAR(std::get<Sphere>(scenario.obstacles[0].shape).radius, 0.04, 1e-15);
}

// ---------------------------------------------------------------- what only a simulation reads

TEST(Scenario, SaysNothingOfWhatOnlyASimulationReads) {
  const test::Workplace place;
  EXPECT_THAT(
      problems_with(place, std::string(least) + "plant: {payload_kg: -3, nonsense: true}\n"
                                                "applied_wrench: not even a list\n"
                                                "sensors: {ideal: perhaps}\n"
                                                "pylon: {x_mm: -240, y_mm: -20, stiffness_N_per_m: soft}\n"),
      ElementsAre());
}

TEST(Scenario, IsStillStrictWithAllElse) {
  const test::Workplace place;
  const auto problems = problems_with(place, std::string(least) +
                                                 "plants: {friction: none}\n"
                                                 "pylon: {x_mm: far, y_mm: -20}\n");
  EXPECT_THAT(problems, ElementsAre(HasSubstr("own.yaml:3: plants: is not a known key"),
                                    HasSubstr("own.yaml:4: pylon.x_mm: ")));
}

TEST(Scenario, ListsEveryParameterThatItReadsWithItsOrigin) {
  const Scenario scenario = read_scenario(shipped("scenarios/platform_collision.yaml"));
  const auto is = [](const std::string& key, const std::string& value, bool from_file) {
    return ::testing::AllOf(Field(&ReadValue::key, key), Field(&ReadValue::value, value),
                            Field(&ReadValue::from_file, from_file));
  };
  EXPECT_THAT(scenario.values, Contains(is("motion.cruise", "0.08", true)));
  EXPECT_THAT(scenario.values, Contains(is("control.momentum_observer.gain", "[20, 20, 20]", true)));
  EXPECT_THAT(scenario.values, Contains(is("control.contact_detector.hard_force", "60", false)));
  EXPECT_THAT(scenario.values, Each(Field(&ReadValue::key, Not(StartsWith("plant")))));
}

TEST(Scenario, LetsOthersReadSectionsOfTheirOwn) {
  const test::Workplace place;
  place.write("scenarios/own.yaml", std::string(least) + "my_observer: {gain_per_s: 30}\n");
  double gain = 0.0;
  const Scenario scenario = read_scenario(
      place / "scenarios/own.yaml", std::nullopt, [&gain](ConfigReader& file, const Scenario& so_far) {
        EXPECT_EQ(so_far.robot.robot->dof(), 3);
        leave_simulation_unread(file, so_far);
        file.section("my_observer").number("gain", unit::per_s, gain, positive);
      });
  EXPECT_EQ(gain, 30.0);
  EXPECT_THAT(scenario.values, Contains(Field(&ReadValue::key, "my_observer.gain")));
}

}  // namespace
}  // namespace flinch
