// A controlled stop knows gravity by the model alone. What hangs on the platform besides leads it down.
#include <gtest/gtest.h>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/plant_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/gate_status.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// A robot that stands still and is stopped after 0.8 s, with more keys of its scenario.
Recording stopped(const std::string& robot, const std::string& keys, const std::string& presses = "") {
  const test::Workplace place;
  place.write("scenarios/own.yaml", "robot: ../robots/" + robot + ".yaml\nduration_s: 2.9\nseed: 1\n" + keys +
                                        "\noperator: [{at_s: 0.8, press: stop}" + presses + "]\n");
  return run_experiment(read_simulated_scenario(place / "scenarios/own.yaml"));
}

Recording stopped_hexapod(const std::string& plant, const std::string& presses = "") {
  return stopped("hexapod_6ups", "plant: {" + plant + "}", presses);
}

GateStatus gate_at(const Recording& recording, std::size_t ms) {
  return read<GateStatus>(recording, "gate")[ms];
}

bool names(const GateStatus& gate, GateFault fault) { return (gate.faults & fault_bit(fault)) != 0; }

TEST(AStop, OfARobotAsItsModelEndsAtRestWithoutBrakes) {
  const GateStatus gate = gate_at(stopped_hexapod("friction: none"), 2500);
  EXPECT_EQ(gate.reaction, GateReaction::controlled_stop);
  EXPECT_FALSE(names(gate, GateFault::stop_ineffective));
}

TEST(AStop, ThatAPayloadLeadsDownEndsInTheBrakes) {
  for (const char* const plant : {"friction: none, payload_kg: 3", "payload_kg: 12"}) {
    const Recording recording = stopped_hexapod(plant);
    EXPECT_EQ(gate_at(recording, 1790).reaction, GateReaction::controlled_stop) << plant;
    const GateStatus gate = gate_at(recording, 1810);
    EXPECT_EQ(gate.reaction, GateReaction::zero_torque_and_brake) << plant;
    EXPECT_TRUE(names(gate, GateFault::stop_ineffective)) << plant;
    EXPECT_LT(read<PlantTruth>(recording, "truth")[2500].velocity.norm(), 1e-3) << plant;
  }
}

TEST(AStop, ThatAPayloadLeadsOnceNobodyHoldsItEndsInTheBrakes) {
  const Recording recording =
      stopped("hexapod_6ups",
              "plant: {friction: none, payload_kg: 3}\n"
              "applied_wrench: [{force_z_N: 29.4, start_ms: 0, rise_ms: 1, hold_ms: 1300, fall_ms: 1}]");
  EXPECT_EQ(gate_at(recording, 2200).reaction, GateReaction::controlled_stop) << "held until 1.3 s";
  EXPECT_EQ(gate_at(recording, 2600).reaction, GateReaction::zero_torque_and_brake);
}

/// At less than 0.25 m/s, for longer than a drift may last, and while some readings are missing.
TEST(AStop, LetsAHandLeadTheRobotAcrossGravity) {
  struct Led {
    const char *robot, *plant, *force;
  };
  for (const auto& [robot, plant, force] :
       {Led{"planar_3rrr", "realism: bench", "12"}, Led{"hexapod_6ups", "friction: none", "30"}}) {
    const Recording recording =
        stopped(robot, std::string("plant: {") + plant + "}\napplied_wrench: [{force_x_N: " + force +
                           ", start_ms: 1300, rise_ms: 200, hold_ms: 2500, fall_ms: 1}]\n"
                           "faults: [{signal: encoders, kind: intermittent, time_s: 2.5, size: 0.02}]");
    EXPECT_EQ(gate_at(recording, 2890).reaction, GateReaction::controlled_stop) << robot;
    const auto truth = read<PlantTruth>(recording, "truth");
    EXPECT_GT(truth[2890].pose[0] - truth[1300].pose[0], 0.1) << robot;
  }
}

TEST(AStop, HeedsNoResetWhileAPayloadLeadsTheRobotAndHeedsItOnceTheBrakesHold) {
  const Recording recording = stopped_hexapod("friction: none, payload_kg: 3",
                                              ", {at_s: 1.5, press: reset}, {at_s: 2, press: reset}");
  EXPECT_EQ(gate_at(recording, 1600).phase, GatePhase::closed);
  EXPECT_EQ(gate_at(recording, 1990).phase, GatePhase::closed);
  EXPECT_EQ(gate_at(recording, 2010).phase, GatePhase::open);
}

}  // namespace
}  // namespace flinch
