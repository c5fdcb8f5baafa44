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

/// A hexapod that stands still and is stopped after 0.8 s.
Recording stopped(const std::string& plant, const std::string& more = "") {
  const test::Workplace place;
  place.write("scenarios/own.yaml", "robot: ../robots/hexapod_6ups.yaml\nduration_s: 2.6\nseed: 1\nplant: {" +
                                        plant + "}\noperator: [{at_s: 0.8, press: stop}" + more + "]\n");
  return run_experiment(read_simulated_scenario(place / "scenarios/own.yaml"));
}

GateStatus gate_at(const Recording& recording, std::size_t ms) {
  return read<GateStatus>(recording, "gate")[ms];
}

bool names(const GateStatus& gate, GateFault fault) { return (gate.faults & fault_bit(fault)) != 0; }

TEST(AStop, OfARobotAsItsModelEndsAtRestWithoutBrakes) {
  const GateStatus gate = gate_at(stopped("friction: none"), 2500);
  EXPECT_EQ(gate.reaction, GateReaction::controlled_stop);
  EXPECT_FALSE(names(gate, GateFault::stop_ineffective));
}

TEST(AStop, ThatAPayloadLeadsDownEndsInTheBrakes) {
  for (const char* const plant : {"friction: none, payload_kg: 3", "payload_kg: 12"}) {
    const Recording recording = stopped(plant);
    EXPECT_EQ(gate_at(recording, 1790).reaction, GateReaction::controlled_stop) << plant;
    const GateStatus gate = gate_at(recording, 1810);
    EXPECT_EQ(gate.reaction, GateReaction::zero_torque_and_brake) << plant;
    EXPECT_TRUE(names(gate, GateFault::stop_ineffective)) << plant;
    EXPECT_LT(read<PlantTruth>(recording, "truth")[2500].velocity.norm(), 1e-3) << plant;
  }
}

TEST(AStop, HeedsNoResetWhileAPayloadLeadsTheRobotAndHeedsItOnceTheBrakesHold) {
  const Recording recording =
      stopped("friction: none, payload_kg: 3", ", {at_s: 1.5, press: reset}, {at_s: 2, press: reset}");
  EXPECT_EQ(gate_at(recording, 1600).phase, GatePhase::closed);
  EXPECT_EQ(gate_at(recording, 1990).phase, GatePhase::closed);
  EXPECT_EQ(gate_at(recording, 2010).phase, GatePhase::open);
}

}  // namespace
}  // namespace flinch
