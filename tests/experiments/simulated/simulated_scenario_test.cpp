#include "experiments/simulated/simulated_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/simulated/experiment.h"
#include "experiments/verdict/verdict.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"
#include "systems/framework/recording.h"
#include "systems/robot/planar_rrr.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using test::shipped;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;

/// The least that a scenario can say.
constexpr const char* least = "robot: ../robots/planar_3rrr.yaml\nduration_s: 0.25\n";

SimulatedScenario scenario_of(const test::Workplace& place, const std::string& text) {
  place.write("scenarios/own.yaml", text);
  return read_simulated_scenario(place / "scenarios/own.yaml");
}

const PlanarRrrParameters& true_parameters(const SimulatedScenario& scenario) {
  return dynamic_cast<const PlanarRrr&>(*scenario.station.rig.robot).parameters();
}

const PlanarRrrParameters& believed(const SimulatedScenario& scenario) {
  return dynamic_cast<const PlanarRrr&>(*scenario.robot.robot).parameters();
}

TEST(ShippedScenarios, AreTheseAndNoOthers) {
  EXPECT_THAT(
      test::shipped_scenarios(),
      ElementsAre("brought_back", "calibration_excitation", "calibration_motion", "calibration_pulls",
                  "calibration_pulls_second", "calibration_rectangle", "calibration_standstill", "clamping",
                  "clamping_reaction", "constraints_without_contact", "delta_calibration_excitation",
                  "delta_calibration_motion", "delta_calibration_pulls", "delta_calibration_rectangle",
                  "delta_calibration_standstill", "delta_collision", "delta_collision_realistic",
                  "first_link_collision", "first_link_reaction", "five_bar_collision", "hexa_collision",
                  "hexa_collision_realistic", "hexapod_calibration_excitation", "hexapod_calibration_motion",
                  "hexapod_calibration_pulls", "hexapod_calibration_rectangle",
                  "hexapod_calibration_standstill", "hexapod_collision", "hexapod_collision_realistic",
                  "hexapod_push", "linapod_collision", "linapod_collision_realistic", "planar_3rpr_collision",
                  "planar_3rpr_collision_realistic", "planar_4rrr_collision",
                  "planar_4rrr_collision_realistic", "platform_collision", "platform_collision_fused",
                  "platform_collision_realistic", "platform_reaction", "random_motion",
                  "reaction_near_itself", "reaction_near_singularity", "second_link_collision",
                  "second_link_reaction", "square", "square_realistic", "square_tasks", "square_unaligned",
                  "stiffness", "tricept_collision", "tricept_collision_realistic", "two_contacts"));
}

TEST(ShippedScenarios, AreAllGood) {
  for (const std::string& name : test::shipped_scenarios()) {
    const SimulatedScenario scenario = read_simulated_scenario(shipped("scenarios/" + name + ".yaml"));
    EXPECT_EQ(scenario.name, name);
    EXPECT_FALSE(scenario.title.empty() || scenario.description.empty()) << name;
    EXPECT_NE(build_experiment(scenario).diagram, nullptr);
  }
}

TEST(SimulatedScenario, HasNothingThatTouchesTheRobotUnlessItSaysSo) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_of(place, least);
  EXPECT_TRUE(scenario.station.rig.obstacles.empty());
  EXPECT_TRUE(scenario.station.applied_wrench.empty());
  EXPECT_EQ(run_experiment(scenario).samples(), 250U);
}

TEST(SimulatedScenario, PutsThePylonWhereTheScenarioSays) {
  const SimulatedScenario scenario = read_simulated_scenario(shipped("scenarios/platform_collision.yaml"));
  ASSERT_EQ(scenario.station.rig.obstacles.size(), 1U);
  const ObstacleForm& pylon = scenario.station.rig.obstacles[0]->form();
  EXPECT_EQ(pylon.position_in_base, Eigen::Vector3d(-0.24, -0.02, 0.0));
  EXPECT_NEAR(std::get<Sphere>(pylon.shape).radius, 0.04, 1e-15);
}

TEST(SimulatedScenario, TellsWhatIsWrongWithItsOwnSectionsAsWell) {
  const test::Workplace place;
  try {
    scenario_of(place, std::string(least) + "plant: {payload_kg: -3}\nsensors: {ideal: perhaps}\n");
    ADD_FAILURE() << "nothing was wrong";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.problems(), ElementsAre(::testing::HasSubstr("own.yaml:3: plant.payload_kg: "),
                                              ::testing::HasSubstr("own.yaml:4: sensors.ideal: ")));
  }
}

TEST(SimulatedScenario, SaysWhereSomethingStandsThatNoSensorAndNoRobotCanDo) {
  const test::Workplace place;
  const std::string text = std::string(least) + "plant:\n  initial_pose: {x_m: 3}\nsensors:\n  imu:\n" +
                           "    before_tick_us: 1000\n    delay_us: 90000\n  force_torque: {delay_ms: 15}\n";
  EXPECT_THAT(
      test::problems_of([&] { scenario_of(place, text); }),
      ElementsAre(EndsWith("own.yaml:4: plant.initial_pose: is out of the reach of the legs; choose a "
                           "nearer pose"),
                  EndsWith("own.yaml:7: sensors.imu.before_tick_us: is 1000; it must be at least 0 and "
                           "less than 1000"),
                  EndsWith("own.yaml:8: sensors.imu.delay_us: is 90000; it must be at least 0 and less "
                           "than 15000"),
                  EndsWith("own.yaml:9: sensors.force_torque.delay_ms: is 15; it must be at least 0 and "
                           "less than 15")));
}

TEST(SimulatedScenario, LetsTheImuHaveAClockOfItsOwn) {
  const test::Workplace place;
  const auto clock_with = [&](const std::string& keys) {
    return scenario_of(place, std::string(least) + "sensors:\n  imu:\n" + keys).station.imu.clock;
  };
  const ImuClockSettings clock =
      clock_with("    {rate_kHz: 1.6, before_tick_us: 600, jitter_us: 100, stamp_jitter_us: 200}\n");
  EXPECT_EQ(clock.period, 625us);
  EXPECT_EQ(clock.before_tick, 600us);
  EXPECT_EQ(clock.jitter, 100us);
  EXPECT_EQ(clock.stamp_jitter, 200us);
  EXPECT_THAT(test::problems_of([&] {
                clock_with(
                    "    rate_Hz: 2000\n    before_tick_us: 500\n    jitter_us: 100\n"
                    "    stamp_jitter_us: 400\n");
              }),
              ElementsAre(EndsWith("own.yaml:6: sensors.imu.before_tick_us: is 500; it must be at least 0 "
                                   "and less than 500"),
                          EndsWith("own.yaml:8: sensors.imu.stamp_jitter_us: is 400; it must be at least 0 "
                                   "and less than 150")));
  EXPECT_THAT(test::problems_of([&] { clock_with("    rate_Hz: 20\n"); }),
              ElementsAre(EndsWith("own.yaml:5: sensors.imu.rate_Hz: is 20; it must lie between 100 and "
                                   "4000")));
}

TEST(SimulatedScenario, SimulatesTheRobotThatTheControllerBelievesIn) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_of(place, least);
  EXPECT_EQ(true_parameters(scenario).platform_mass, believed(scenario).platform_mass);
  EXPECT_EQ(true_parameters(scenario).legs[1].active_friction.coulomb,
            believed(scenario).legs[1].active_friction.coulomb);
}

TEST(SimulatedScenario, CanLetThePlantDifferFromTheModel) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_of(
      place, std::string(least) + "plant: {friction: none, payload_kg: 0.5, leg_inertia_scale: 1.1}\n");
  const PlanarRrrParameters& plant = true_parameters(scenario);
  EXPECT_EQ(plant.platform_mass, believed(scenario).platform_mass + 0.5);
  EXPECT_EQ(plant.legs[2].inertia.p1, believed(scenario).legs[2].inertia.p1 * 1.1);
  EXPECT_EQ(plant.legs[0].active_friction.coulomb, 0.0);
  EXPECT_GT(believed(scenario).legs[0].active_friction.coulomb, 0.0);
}

TEST(SimulatedScenario, MeasuresDrivesThatSlideInMetres) {
  const test::Workplace place;
  const std::string hexapod = "robot: ../robots/hexapod_6ups.yaml\nduration_s: 0.25\n";
  EXPECT_EQ(scenario_of(place, hexapod).station.encoders.active.noise, 7e-6);
  EXPECT_EQ(scenario_of(place, hexapod + "sensors: {encoders: {active: {noise_mm: 0.002}}}\n")
                .station.encoders.active.noise,
            2e-6);
  EXPECT_THROW(scenario_of(place, hexapod + "sensors: {encoders: {active: {noise_deg: 4.0e-4}}}\n"),
               SetupError);
  EXPECT_NEAR(scenario_of(place, least).station.encoders.active.noise, 7e-6, 1e-7);  // [rad]
}

TEST(SimulatedScenario, StartsWhereItsMotionStarts) {
  for (const std::string& name : test::shipped_scenarios()) {
    const SimulatedScenario scenario = read_simulated_scenario(shipped("scenarios/" + name + ".yaml"));
    const auto& path = scenario.control.trajectory.path;
    const auto& start = scenario.station.rig.initial_pose;
    ASSERT_EQ(start.has_value(), path.has_value()) << name;
    if (path) {
      EXPECT_EQ(*start, path->start()) << name;
    }
  }
}

TEST(SimulatedScenario, TakesTheSeedOfTheCommandLine) {
  const std::filesystem::path file = shipped("scenarios/square.yaml");
  EXPECT_EQ(read_simulated_scenario(file).seed, 1U);
  EXPECT_EQ(read_simulated_scenario(file).station.seed, 1U);
  EXPECT_EQ(read_simulated_scenario(file, 18446744073709551615U).seed, 18446744073709551615U);
  EXPECT_EQ(read_simulated_scenario(file, 7).station.seed, 7U);
}

TEST(SimulatedScenario, TakesOtherValuesThanThoseOfTheFile) {
  const std::filesystem::path file = shipped("scenarios/square.yaml");
  const SimulatedScenario scenario =
      read_simulated_scenario(file, {"duration_s=0.5", "plant.payload_kg=0.3"}, 7);
  EXPECT_EQ(scenario.duration, 500ms);
  EXPECT_EQ(scenario.seed, 7U);
  EXPECT_EQ(read_scenario(file, {"duration_s=0.5"}).duration, 500ms);
  EXPECT_EQ(read_simulated_scenario(file, std::vector<std::string>()).text, test::bytes_of(file))
      << "with its comments, where nothing is changed";
}

// Nothing but the pose of the begin tells then on which branch the platform is.
TEST(SimulatedScenario, RunsWithoutPassiveEncodersFromAPoseThatIsTold) {
  const std::filesystem::path file = shipped("scenarios/platform_collision.yaml");
  std::vector<std::string> set = {"sensors.encoders.passive_mounted=false"};
  const Verdict lost = judge_experiment(read_simulated_scenario(file, set));
  EXPECT_THAT(lost.failures, Contains("the torque gate never opened: the platform's pose is not known"));
  set.emplace_back("control.forward_kinematics.initial_pose={x_mm: 70, y_mm: 5, phi_deg: 1}");
  const Verdict told = judge_experiment(read_simulated_scenario(file, set));
  EXPECT_TRUE(told.good()) << (told.failures.empty() ? "" : told.failures.front());
}

TEST(SimulatedScenario, ListsEveryParameterWithItsOrigin) {
  const SimulatedScenario scenario = read_simulated_scenario(shipped("scenarios/platform_collision.yaml"));
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

TEST(SimulatedScenario, ComesBackOutOfItsRecording) {
  test::Workplace place;
  place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.05");
  const SimulatedScenario scenario = read_simulated_scenario(place / "scenarios/platform_collision.yaml", 42);
  const SimulatedScenario again = recorded_simulated_scenario(run_experiment(scenario), "run.h5");
  EXPECT_EQ(again.name, scenario.name);
  EXPECT_EQ(again.seed, 42U);
  EXPECT_EQ(again.text, scenario.text);
  EXPECT_EQ(again.robot_text, scenario.robot_text);
  EXPECT_EQ(again.expected.contact, scenario.expected.contact);
  EXPECT_EQ(again.station.rig.initial_pose, scenario.station.rig.initial_pose);
}

}  // namespace
}  // namespace flinch
