#include "experiments/simulated/scenario_realism.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <future>
#include <numbers>
#include <string_view>

#include "experiments/recorded/replay.h"
#include "experiments/recorded/robot_as_drawn.h"
#include "experiments/report/experiment_report.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"
#include "systems/robot/planar_rrr.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

SimulatedScenario scenario_with(const test::Workplace& place, const std::string& plant,
                                const std::string& robot = "planar_3rrr", std::uint64_t seed = 1) {
  place.write("scenarios/own.yaml",
              "robot: ../robots/" + robot + ".yaml\nduration_s: 0.3\nplant: {" + plant + "}\n");
  return read_simulated_scenario(place / "scenarios/own.yaml", seed);
}

std::vector<std::string> problems_with(const std::string& plant, const std::string& robot = "planar_3rrr") {
  const test::Workplace place;
  try {
    scenario_with(place, plant, robot);
  } catch (const SetupError& error) {
    return error.problems();
  }
  return {};
}

std::vector<std::string> keys_of(const SimulatedScenario& scenario) {
  std::vector<std::string> keys;
  for (const auto& [key, values] : perturbed_robot_values(scenario.perturbed_robot, *scenario.robot.robot)) {
    keys.push_back(key);
  }
  return keys;
}

TEST(ScenarioRealism, IsNoneUnlessItIsAskedFor) {
  const test::Workplace place;
  EXPECT_THAT(keys_of(scenario_with(place, "friction: as_robot_file")), ElementsAre());
  EXPECT_THAT(keys_of(scenario_with(place, "realism: none")), ElementsAre());
  EXPECT_EQ(keys_of(scenario_with(place, "realism: bench")).size(), 23U);
}

TEST(ScenarioRealism, CanBeSetSizeBySize) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(
      place,
      "realism: {friction: 0.3, current_lag_ms: 0.5, cogging: 0.01, cogging_periods: 12, payload_g: 300}");
  EXPECT_THAT(keys_of(scenario), ElementsAre("drive_friction_scale", "passive_friction_scale", "payload_kg",
                                             "cogging_Nm", "cogging_phase_rad", "current_lag_s"));
  EXPECT_EQ(scenario.station.rig.torque_ripple[0].cogging[0].rate, 12.0);
  EXPECT_EQ(scenario.station.drives.current_lag, scenario.perturbed_robot.current_lag);
}

TEST(ScenarioRealism, IsThatOfTheRunUnlessTheRobotHasASeedOfItsOwn) {
  const test::Workplace place;
  const auto payload = [&](const std::string& realism, std::uint64_t seed) {
    return scenario_with(place, realism, "planar_3rrr", seed).perturbed_robot.mechanics.payload;
  };
  const double seventh = payload("realism: bench", 7);
  EXPECT_NE(payload("realism: bench", 8), seventh);
  EXPECT_EQ(payload("realism: {like: bench, seed: 7}", 8), seventh);
}

TEST(ScenarioRealism, CanBeLikeTheBenchButForWhatItSays) {
  const test::Workplace place;
  const SimulatedScenario rig = scenario_with(place, "realism: bench");
  const SimulatedScenario other = scenario_with(place, "realism: {like: bench, torque_constant: 0}");
  EXPECT_EQ(other.perturbed_robot.mechanics.payload, rig.perturbed_robot.mechanics.payload);
  EXPECT_EQ(other.perturbed_robot.torque_constant_scale.size(), 0);
  EXPECT_EQ(rig.perturbed_robot.torque_constant_scale.size(), 3);
}

TEST(ScenarioRealism, ComesOnTopOfWhatThePlantSays) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(
      place,
      "drive_friction_scale: [2, 1, 1], passive_friction_scale: [1, 0, 1], payload_kg: 0.5, realism: bench");
  const auto& truth = dynamic_cast<const PlanarRrr&>(*scenario.station.rig.robot).parameters();
  const auto& model = dynamic_cast<const PlanarRrr&>(*scenario.robot.robot).parameters();
  const RobotDeviation& drawn = scenario.perturbed_robot.mechanics;
  EXPECT_DOUBLE_EQ(truth.legs[0].active_friction.coulomb,
                   2.0 * model.legs[0].active_friction.coulomb * drawn.drive_friction_scale[0]);
  EXPECT_EQ(truth.legs[1].passive_friction.viscous, 0.0);
  EXPECT_NEAR(truth.platform_mass, (model.platform_mass + 0.5) * drawn.platform_inertia_scale + drawn.payload,
              1e-12);
  EXPECT_EQ(scenario.station.drives.driver_torque_constant, scenario.robot.drives.torque_constant);
}

TEST(ScenarioRealism, LetsMotorsCogAsTheRobotFileSays) {
  test::Workplace place;
  place.replace("robots/planar_3rrr.yaml", "\ndrives:\n",
                "\ndrives:\n  cogging_wavelength_rad: [0.25, 0.25, 0.5]\n  cogging_sine_Nm: [0.3, 0, 0]\n"
                "  cogging_cosine_Nm: [0.4, 0, -0.2]\n  cogging2_wavelength_rad: [0.125, 0.1, 0.2]\n"
                "  cogging2_sine_Nm: [0, 0.1, 0]\n  cogging2_cosine_Nm: [0.2, 0, 0]\n");
  for (const char* const plant : {"friction: as_robot_file", "realism: bench"}) {
    const SimulatedScenario scenario = scenario_with(place, plant);
    const Cogging& known = scenario.control.drive_torque.cogging;
    const std::vector<TorqueRipple>& motors = scenario.station.rig.torque_ripple;
    ASSERT_EQ(known.waves.size(), 2U);
    ASSERT_EQ(motors.size(), 3U);
    for (const double q : {-0.7, 0.0, 0.3}) {
      const JointVector expected = known.at(JointVector::Constant(3, q));
      for (int i = 0; i < 3; ++i) {
        const auto& waves = motors[static_cast<std::size_t>(i)].cogging;
        ASSERT_EQ(waves.size(), 2U);
        EXPECT_NEAR(waves[0].at(q) + waves[1].at(q), expected[i], 1e-14) << plant;
      }
    }
    EXPECT_EQ(motors[0].ripple.amplitude > 0.0, std::string_view(plant) == "realism: bench");
  }
}

TEST(ScenarioRealism, CutsTorquesWhereTheRobotFileSays) {
  const test::Workplace place;
  place.replace("robots/five_bar.yaml", "max_torque_Nm: 10", "max_torque_Nm: 12");
  EXPECT_EQ(scenario_with(place, "", "five_bar").station.drives.max_torque, JointVector::Constant(2, 12.0));
}

TEST(ScenarioRealism, HasTheUnitsOfDrivesThatSlide) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(
      place,
      "realism: {active_encoder_wave_mm: 0.004, cogging: 0.005, force_constant: 0.01, screw_lead_mm: 10}",
      "hexapod_6ups");
  EXPECT_THAT(keys_of(scenario), ElementsAre("force_constant_scale", "cogging_N", "cogging_phase_rad",
                                             "active_encoder_wave_m", "active_encoder_wave_phase_rad"));
  EXPECT_DOUBLE_EQ(scenario.perturbed_robot.active_encoder_wave[5].rate, 2.0 * std::numbers::pi / 0.01);
  EXPECT_THAT(problems_with("realism: {screw_lead_mm: 5}"),
              ElementsAre(HasSubstr("own.yaml:3: plant.realism.screw_lead_mm: is not a known key")));
  EXPECT_THAT(problems_with("realism: {passive_encoder_wave_deg: 0.1}", "hexapod_6ups"),
              ElementsAre(HasSubstr("plant.realism.passive_encoder_wave_deg: is not a known key")));
}

TEST(ScenarioRealism, PutsSpringsBetweenMotorsAndLegs) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(
      place, "realism: {drive_stiffness_Nm_per_rad: 60000, backlash_deg: 0.05, rotor_inertia_kg_m2: 0.1}");
  EXPECT_THAT(keys_of(scenario), ElementsAre("drive_stiffness_Nm_per_rad", "backlash_rad"));
  EXPECT_EQ(scenario.station.rig.elastic.rotor_inertia, JointVector::Constant(3, 0.1));
  EXPECT_THAT(keys_of(scenario_with(place, "realism: {drive_stiffness_N_per_m: 1e7}", "hexapod_6ups")),
              ElementsAre("drive_stiffness_N_per_m"));
  EXPECT_THAT(problems_with("realism: {backlash_deg: 0.05}"),
              ElementsAre(HasSubstr("backlash_deg: needs a drive_stiffness above 0")));
}

TEST(ScenarioRealism, TellsWhatIsWrongWithIt) {
  EXPECT_THAT(problems_with("realism: bensh"),
              ElementsAre(HasSubstr("own.yaml:3: plant.realism: is 'bensh'; did you mean 'bench'?")));
  EXPECT_THAT(problems_with("realism: [bench]"), ElementsAre(HasSubstr("plant.realism: is a list")));
  EXPECT_THAT(problems_with("realism: {frction: 0.2}"), ElementsAre(HasSubstr("did you mean 'friction'?")));
  EXPECT_THAT(
      problems_with("realism: {friction: 1.2, cogging: -1, current_lag_ms: 200, cogging_periods: 0}"),
      ElementsAre(HasSubstr("friction: is 1.2; it must lie between 0 and 1"), HasSubstr("cogging: is -1"),
                  HasSubstr("cogging_periods: is 0"), HasSubstr("current_lag_ms: is 200")));
  EXPECT_THAT(problems_with("realism: {current_lag: 0.1}"), ElementsAre(HasSubstr("current_lag_ms")));
}

// ---------------------------------------------------------------- runs

bool is_same(const Signal& a, const Signal& b) {
  return a.path == b.path && a.rows.size() == b.rows.size() &&
         std::memcmp(a.rows.data(), b.rows.data(), a.rows.size() * sizeof(a.rows[0])) == 0;
}

TEST(RealisticRun, GivesTheSameBitsAloneAndBesideOthers) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(place, "realism: bench", "planar_3rrr", 9);
  const Recording alone = run_experiment(scenario);
  std::vector<std::future<Recording>> runs;
  for (int i = 0; i < 4; ++i)
    runs.push_back(std::async(std::launch::async, [&] { return run_experiment(scenario); }));
  for (auto& run : runs) {
    const Recording beside = run.get();
    ASSERT_EQ(beside.signals.size(), alone.signals.size());
    for (std::size_t i = 0; i < alone.signals.size(); ++i) {
      EXPECT_TRUE(is_same(beside.signals[i], alone.signals[i])) << alone.signals[i].path;
    }
    EXPECT_EQ(robot_as_drawn(beside), robot_as_drawn(alone));
  }
}

TEST(RealisticRun, DiffersFromTheModelAndFromRobotToRobot) {
  const test::Workplace place;
  const auto torque = [&](const std::string& plant, std::uint64_t seed) {
    const Recording run = run_experiment(scenario_with(place, plant, "planar_3rrr", seed));
    return run.column("truth", "drive_torque", 0).back();
  };
  EXPECT_EQ(torque("realism: none", 1), torque("friction: as_robot_file", 1));
  EXPECT_NE(torque("realism: bench", 1), torque("realism: none", 1));
  EXPECT_NE(torque("realism: bench", 1), torque("realism: bench", 2));
}

TEST(RealisticRun, RecordsTheRobotThatWasDrawnAndShowsIt) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(place, "realism: bench");
  const Recording run = run_experiment(scenario);
  const DrawnValues drawn = robot_as_drawn(run);
  EXPECT_EQ(drawn, perturbed_robot_values(scenario.perturbed_robot, *scenario.robot.robot)) << "bit for bit";
  EXPECT_EQ(robot_as_drawn(replay(scenario, run).recording), drawn);

  const Verdict verdict = judge(run, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  const Report report = experiment_report(scenario, run, verdict);
  std::size_t shown = 0;
  for (const ReportParameter& row : report.parameters) shown += row.group == "robot as drawn" ? 1 : 0;
  EXPECT_EQ(shown, drawn.size());
}

TEST(RealisticRun, SaysNothingOfARobotThatIsAsItsModel) {
  const test::Workplace place;
  const SimulatedScenario scenario = scenario_with(place, "realism: none");
  EXPECT_TRUE(robot_as_drawn(run_experiment(scenario)).empty());
  Recording spoilt;
  spoilt.attributes["robot.drawn.text"] = "{\"cogging_Nm\": [0.1";
  EXPECT_THROW(robot_as_drawn(spoilt), SetupError);
}

}  // namespace
}  // namespace flinch
