// The closed loop of every scenario that ships: that it takes no memory while it runs, never comes apart, and
// gives the same bits again, from the start, in two threads, and from what was recorded of its sensors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "experiments/recorded/replay.h"
#include "experiments/scenario/scenario_calibrations.h"
#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "plant/plant_truth.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/quantity_units.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/allocations.h"
#include "tests/support/same_signals.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

SimulatedScenario scenario_called(const std::string& name, std::optional<std::uint64_t> seed = std::nullopt) {
  return read_simulated_scenario(test::shipped("scenarios/" + name + ".yaml"), seed);
}

/// Its first seconds; motions and pulls that go on for longer do the same again.
SimulatedScenario beginning_of(const std::string& name, std::optional<std::uint64_t> seed = std::nullopt) {
  SimulatedScenario scenario = scenario_called(name, seed);
  scenario.duration = std::min<Time>(scenario.duration, 8s);
  return scenario;
}

void expect_same(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.signals.size(), b.signals.size());
  for (const Signal& signal : a.signals) EXPECT_TRUE(test::is_same(a, b, signal.path)) << signal.path;
  EXPECT_EQ(a.attributes, b.attributes);
}

/// All but minutes of hexapods, which the campaign of their calibration runs.
std::vector<std::string> short_scenarios() {
  std::vector<std::string> names = test::shipped_scenarios();
  std::erase_if(names, [](const std::string& name) { return name.starts_with("hexapod_calibration"); });
  return names;
}

class ClosedLoop : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, ClosedLoop, ::testing::ValuesIn(short_scenarios()),
                         [](const auto& tested) { return tested.param; });

TEST_P(ClosedLoop, TakesNoMemoryThroughContactAndReaction) {
  const SimulatedScenario scenario = beginning_of(GetParam());
  const Experiment experiment = build_experiment(scenario);
  const auto ticks = static_cast<std::size_t>(scenario.duration / 1ms);
  Recorder recorder(*experiment.diagram, recordable_paths(*experiment.diagram), ticks,
                    quantity_units(*scenario.robot.robot));
  Simulator simulator(*experiment.diagram, std::make_unique<SundialsIntegrator>());
  simulator.record(recorder);
  Context context = experiment.diagram->make_context();
  for (int tick = 0; tick < 3; ++tick) simulator.step(context);

  const test::AllocationCounter allocations;
  for (std::size_t tick = 3; tick < ticks; ++tick) simulator.step(context);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(recorder.dropped(), 0);
  EXPECT_EQ(simulator.inaccurate_steps(), 0);
}

TEST_P(ClosedLoop, GoesThroughWhatItIsMeantToShow) {
  const SimulatedScenario scenario = scenario_called(GetParam());
  const Recording recording = run_experiment(scenario);
  const std::vector<double> modes = recording.column("reaction", "mode");
  const auto reached = [&modes](ReactionMode mode) {
    return std::find(modes.begin(), modes.end(), static_cast<double>(mode)) != modes.end();
  };
  const bool touches = scenario.expected.contact != "none";
  EXPECT_TRUE(reached(ReactionMode::nominal));
  EXPECT_EQ(reached(ReactionMode::react), touches);
  const Verdict verdict =
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  EXPECT_TRUE(verdict.good()) << verdict.failures.front();
  EXPECT_EQ(std::all_of(verdict.contacts.begin(), verdict.contacts.end(),
                        [](const ContactVerdict& contact) { return contact.is_push; }),
            scenario.obstacles.empty());
}

TEST_P(ClosedLoop, KeepsItsLegsTogether) {
  const Recording recording = run_experiment(scenario_called(GetParam()));
  double largest = 0.0;
  for (const double miss : recording.column("truth", "loop_closure_error")) largest = std::max(largest, miss);
  EXPECT_LE(largest, 1e-9);
  for (const double valid : recording.column("truth", "valid")) ASSERT_EQ(valid, 1.0);
}

TEST_P(ClosedLoop, GivesTheSameBitsInTwoThreadsAtOnce) {
  const SimulatedScenario scenario = beginning_of(GetParam());
  Recording first, second;
  std::thread a([&] { first = run_experiment(scenario); });
  std::thread b([&] { second = run_experiment(scenario); });
  a.join();
  b.join();
  expect_same(first, second);
  expect_same(first, run_experiment(scenario));
}

TEST_P(ClosedLoop, MeasuresOtherNoiseWithAnotherSeed) {
  const Recording one = run_experiment(beginning_of(GetParam(), 1));
  const Recording two = run_experiment(beginning_of(GetParam(), 2));
  EXPECT_FALSE(test::is_same(one, two, "joints"));
  EXPECT_FALSE(test::is_same(one, two, "torque_command"));
}

TEST_P(ClosedLoop, IsReplayedBitForBitFromItsRecordingFile) {
  const test::Workplace place;
  const SimulatedScenario scenario = beginning_of(GetParam());
  write_recording(run_experiment(scenario), place / "run.h5");
  const Recording recorded = read_recording(place / "run.h5");
  const Replay replayed = replay(recorded_scenario(recorded, place / "run.h5"), recorded);
  EXPECT_THAT(replayed.differing, testing::IsEmpty());
  for (const std::string path : {"wrench", "detection", "reaction", "torque_command", "brake", "gate"}) {
    EXPECT_TRUE(test::is_same(recorded, replayed.recording, path)) << path;
  }
}

TEST(AClosedLoop, GoesTickByTickAsInTheExperimentWithWhatItIsToldOfContacts) {
  SimulatedScenario scenario = scenario_called("reaction_near_singularity");
  scenario.station.told_contact = "truth";
  const Recording recording = run_for_signals(scenario, {"truth"});
  const auto truth = read<PlantTruth>(recording, "truth");
  test::ScenarioLoop loop(scenario);
  for (std::size_t tick = 0; tick < truth.size(); ++tick) {
    loop.tick();
    ASSERT_EQ(loop.context.get(loop.station.plant_truth).pose, truth[tick].pose);
  }
}

TEST(Replay, TellsAnotherControlPathFromTheRecordedOne) {
  SimulatedScenario scenario = scenario_called("platform_collision");
  const Recording recorded = run_experiment(scenario);
  scenario.control.momentum_observer.gain *= 2.0;
  const Replay replayed = replay(scenario, recorded);
  EXPECT_TRUE(test::is_same(recorded, replayed.recording, "motion"));
  EXPECT_FALSE(test::is_same(recorded, replayed.recording, "wrench"));
  EXPECT_THAT(replayed.differing, testing::Contains("wrench"));
  EXPECT_THAT(replayed.differing, testing::Not(testing::Contains("motion")));
}

// Its platform weighs what others have found out since: what it commands has never reached the drives.
TEST(Replay, DoesNotBlameDrivesForTheCommandsOfARobotThatWasCalibratedSince) {
  SimulatedScenario scenario = scenario_called("delta_calibration_motion");
  scenario.duration = 2s;
  const Recording recorded = run_experiment(scenario);
  ParameterFile heavier;
  heavier.text = "platform of 1.2 kg";
  heavier.parameters = {{.name = "platform.mass_kg", .value = 1.2, .belongs_to = "robot"}};
  scenario.calibrations = {heavier};
  scenario.robot = calibrated_robot(scenario);
  const Replay replayed = replay(scenario, recorded);
  const std::vector<double> faults = replayed.recording.column("gate", "fault");
  EXPECT_EQ(*std::max_element(faults.begin(), faults.end()), 0.0);
}

}  // namespace
}  // namespace flinch
