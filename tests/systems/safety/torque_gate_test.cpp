#include "systems/safety/torque_gate.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/safety/fault_table.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr FaultMask none = 0;
constexpr FaultMask stopping = fault_bit(GateFault::workspace_radius);  // asks for a controlled stop
constexpr FaultMask braking = fault_bit(GateFault::station_fault);      // asks for the brakes

TorqueCommand command(double x, double y, double z, bool valid = true) {
  return {.computed = {}, .valid = valid, .torque = Eigen::Vector3d(x, y, z)};
}

struct Gate {
  explicit Gate(const TorqueGateSettings& settings = {})
      : block(builder.add<TorqueGate>("gate", settings)),
        faults(builder.export_input("faults", block.faults)),
        asked(builder.export_input("command", block.command)),
        stop(builder.export_input("stop", block.stop)),
        reset(builder.export_input("reset", block.reset)) {
    ticking.set(asked, command(1, 2, 3));
    ticking.set(stop, command(-1, -2, -3));
  }

  /// One tick with these faults present.
  const GateStatus& tick(FaultMask present, bool reset_now = false) {
    ticking.set(faults, {.valid = true, .present = present, .tolerable = tolerable, .at_rest = at_rest});
    ticking.set(reset, {.reset = reset_now});
    ticking.tick();
    return status();
  }
  const GateStatus& status() const { return ticking.get(block.status); }
  const TorqueCommand& torque() const { return ticking.get(block.torque_command); }
  bool brakes() const { return ticking.get(block.brake).engage; }

  FaultMask tolerable = 0;
  bool at_rest = true;
  DiagramBuilder builder;
  TorqueGate& block;
  InputPort<FaultReport> faults;
  InputPort<TorqueCommand> asked;
  InputPort<TorqueCommand> stop;
  InputPort<ResetCommand> reset;
  test::Ticking ticking{builder};
};

// ---------------------------------------------------------------- phases

TEST(TorqueGate, WaitsWithBrakesClosedUntilATickWithoutFaults) {
  Gate gate;
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(gate.tick(braking | stopping).phase, GatePhase::waiting);
    EXPECT_EQ(gate.status().faults, braking | stopping);
    EXPECT_EQ(gate.status().fault, GateFault::none);
    EXPECT_FALSE(gate.torque().valid);
    EXPECT_TRUE(gate.brakes());
  }
  EXPECT_EQ(gate.tick(none).phase, GatePhase::open);
  EXPECT_EQ(gate.status().since, 5ms);
  EXPECT_TRUE(gate.torque().valid);
  EXPECT_FALSE(gate.brakes());
}

TEST(TorqueGate, LetsTheTorquesThroughWhileOpen) {
  Gate gate;
  gate.tick(none);
  gate.tick(none);
  EXPECT_EQ(gate.torque().torque, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(gate.torque().computed, 1ms);
  EXPECT_EQ(gate.status().reaction, GateReaction::none);
  EXPECT_FALSE(gate.status().saturated);
}

TEST(TorqueGate, ClosesAtTheTickOfTheFaultAndStaysClosed) {
  Gate gate;
  gate.tick(none), gate.tick(none);
  gate.tick(stopping);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(gate.status().phase, GatePhase::closed);
    EXPECT_EQ(gate.status().fault, GateFault::workspace_radius);
    EXPECT_EQ(gate.status().since, 2ms);
    EXPECT_EQ(gate.status().reaction, GateReaction::controlled_stop);
    EXPECT_EQ(gate.torque().torque, Eigen::Vector3d(-1, -2, -3));
    EXPECT_FALSE(gate.brakes());
    gate.tick(none);
  }
}

TEST(TorqueGate, ReportsTheFirstFaultAndCollectsTheOthers) {
  Gate gate;
  gate.tick(none);
  gate.tick(stopping | fault_bit(GateFault::control_error));
  gate.tick(fault_bit(GateFault::drives_stale));
  gate.tick(none);
  EXPECT_EQ(gate.status().fault, GateFault::workspace_radius);
  EXPECT_EQ(gate.status().faults,
            stopping | fault_bit(GateFault::control_error) | fault_bit(GateFault::drives_stale));
}

TEST(TorqueGate, TurnsToTheWorseReactionButNeverBack) {
  Gate gate;
  gate.tick(none);
  EXPECT_EQ(gate.tick(stopping).reaction, GateReaction::controlled_stop);
  EXPECT_EQ(gate.tick(braking).reaction, GateReaction::zero_torque_and_brake);
  EXPECT_FALSE(gate.torque().valid);
  EXPECT_TRUE(gate.brakes());
  EXPECT_EQ(gate.tick(stopping).reaction, GateReaction::zero_torque_and_brake);
  EXPECT_EQ(gate.tick(none).reaction, GateReaction::zero_torque_and_brake);
  EXPECT_TRUE(gate.brakes());
}

TEST(TorqueGate, OpensAgainOnlyByResetAtATickWithoutFaults) {
  Gate gate;
  gate.tick(none);
  gate.tick(braking);
  EXPECT_EQ(gate.tick(braking, true).phase, GatePhase::closed);
  EXPECT_EQ(gate.tick(none).phase, GatePhase::closed);
  EXPECT_EQ(gate.tick(none, true).phase, GatePhase::open);
  EXPECT_EQ(gate.status().fault, GateFault::station_fault) << "what happened last remains readable";
  EXPECT_EQ(gate.status().faults, none);
  EXPECT_TRUE(gate.torque().valid);
  EXPECT_FALSE(gate.brakes());
}

TEST(TorqueGate, HeedsNoResetWhileTheRobotMoves) {
  for (const FaultMask left : {none, stopping}) {
    Gate gate;
    gate.tick(none);
    gate.tick(stopping);
    gate.tolerable = left;
    gate.at_rest = false;
    EXPECT_EQ(gate.tick(left, true).phase, GatePhase::closed);
    EXPECT_EQ(gate.torque().torque, Eigen::Vector3d(-1, -2, -3)) << "the controlled stop goes on";
    gate.at_rest = true;
    EXPECT_EQ(gate.tick(left).phase, GatePhase::closed) << "nor is it kept";
    EXPECT_EQ(gate.tick(left, true).phase, left == none ? GatePhase::open : GatePhase::recovering);
  }
}

TEST(TorqueGate, BeginsNoRecoveryOfARobotThatMovesAtTheStart) {
  Gate gate;
  gate.tolerable = stopping;
  gate.at_rest = false;
  EXPECT_EQ(gate.tick(stopping, true).phase, GatePhase::waiting);
}

TEST(TorqueGate, IsNotClosedByAReset) {
  Gate gate;
  gate.tick(none);
  EXPECT_EQ(gate.tick(none, true).phase, GatePhase::open);
}

// ---------------------------------------------------------------- what it does not rely on

TEST(TorqueGate, BrakesWhereTheControlledStopHasNoTorques) {
  const TorqueCommand unusable[] = {
      command(0, 0, 0, false), command(0, nan, 0), {.computed = {}, .valid = true, .torque = {}}};
  for (const TorqueCommand& stop : unusable) {
    Gate gate;
    gate.tick(none);
    gate.ticking.set(gate.stop, stop);
    EXPECT_EQ(gate.tick(stopping).reaction, GateReaction::zero_torque_and_brake);
    EXPECT_FALSE(gate.torque().valid);
    EXPECT_TRUE(gate.brakes());
    gate.ticking.set(gate.stop, command(0, 0, 0));
    EXPECT_EQ(gate.tick(none).reaction, GateReaction::zero_torque_and_brake) << "and stays there";
  }
}

TEST(TorqueGate, BrakesWhenTheControlledStopFailsLater) {
  Gate gate;
  gate.tick(none);
  gate.tick(stopping);
  gate.ticking.set(gate.stop, command(nan, 0, 0));
  EXPECT_EQ(gate.tick(none).reaction, GateReaction::zero_torque_and_brake);
  EXPECT_TRUE(gate.brakes());
}

TEST(TorqueGate, ClosesOnAnUnusableCommandEvenIfNobodyReportsIt) {
  for (const TorqueCommand& asked : {command(0, 0, 0, false), command(nan, 0, 0)}) {
    Gate gate;
    gate.tick(none);
    gate.ticking.set(gate.asked, asked);
    EXPECT_EQ(gate.tick(none).phase, GatePhase::closed);
    EXPECT_EQ(gate.status().fault, GateFault::command_invalid);
    EXPECT_TRUE(gate.torque().torque.allFinite());
  }
}

TEST(TorqueGate, BrakesWithoutAFaultReport) {
  Gate gate;
  gate.tick(none);
  gate.ticking.set(gate.faults, {});
  gate.ticking.tick();
  EXPECT_EQ(gate.status().reaction, GateReaction::zero_torque_and_brake);
  EXPECT_TRUE(gate.brakes());
}

// ---------------------------------------------------------------- limits

TEST(TorqueGate, BoundsTheTorqueOfEveryDrive) {
  Gate gate({.max_torque = 50.0, .max_torque_rate = 1e9});
  gate.tick(none);
  gate.ticking.set(gate.asked, command(49.0, 120.0, -51.0));
  EXPECT_TRUE(gate.tick(none).saturated);
  EXPECT_EQ(gate.torque().torque, Eigen::Vector3d(49.0, 50.0, -50.0));
  gate.ticking.set(gate.asked, command(49.0, 50.0, -50.0));
  EXPECT_FALSE(gate.tick(none).saturated);
}

TEST(TorqueGate, BoundsTheRateFromTheLastTorqueThatWasWritten) {
  Gate gate({.max_torque = 100.0, .max_torque_rate = 5e3});
  gate.tick(none);
  gate.ticking.set(gate.asked, command(12.0, -3.0, 0.0));
  const double expected[] = {5.0, 10.0, 12.0};
  for (const double torque : expected) {
    EXPECT_EQ(gate.tick(none).saturated, torque < 12.0);
    EXPECT_NEAR(gate.torque().torque[0], torque, 1e-12);
  }
  gate.tick(stopping);
  EXPECT_NEAR(gate.torque().torque[0], 7.0, 1e-12) << "also into the controlled stop";
}

TEST(TorqueGate, StartsFromNoTorqueAfterTheBrakes) {
  Gate gate({.max_torque = 100.0, .max_torque_rate = 5e3});
  gate.ticking.set(gate.asked, command(80.0, 0.0, 0.0));
  for (int k = 0; k < 20; ++k) gate.tick(none);
  EXPECT_NEAR(gate.torque().torque[0], 80.0, 1e-12);
  gate.tick(braking);
  EXPECT_EQ(gate.torque().torque, JointVector::Zero(3));
  gate.tick(none, true);
  EXPECT_NEAR(gate.torque().torque[0], 5.0, 1e-12);
}

/// Whatever comes in, what goes out is finite, bounded, bounded in rate, and the brakes are open only with
/// torques.
TEST(TorqueGate, WritesOnlySafeTorquesWhateverItIsGiven) {
  RandomGenerator random(3);
  Gate gate({.max_torque = 60.0, .max_torque_rate = 7e3});
  const auto any = [&random] {
    const double kind = random.uniform(0.0, 1.0);
    if (kind < 0.02) return nan;
    if (kind < 0.04) return std::numeric_limits<double>::infinity();
    return random.uniform(-200.0, 200.0);
  };
  JointVector last = JointVector::Zero(3);
  int torques = 0;
  for (int k = 0; k < 20000; ++k) {
    gate.ticking.set(gate.asked, command(any(), any(), any(), random.uniform(0.0, 1.0) < 0.99));
    gate.ticking.set(gate.stop, command(any(), any(), any(), random.uniform(0.0, 1.0) < 0.99));
    gate.tick(random.uniform(0.0, 1.0) < 0.98 ? none : stopping, random.uniform(0.0, 1.0) < 0.1);
    const TorqueCommand& written = gate.torque();
    ASSERT_TRUE(written.torque.allFinite());
    ASSERT_LE(written.torque.lpNorm<Eigen::Infinity>(), 60.0);
    ASSERT_EQ(gate.brakes(), !written.valid);
    if (written.valid) {
      ASSERT_LE((written.torque - last).lpNorm<Eigen::Infinity>(), 7.0 + 1e-12);
    } else {
      ASSERT_EQ(written.torque, JointVector::Zero(3));
    }
    torques += written.valid ? 1 : 0;
    last = written.torque;
  }
  EXPECT_GT(torques, 5000);
}

TEST(TorqueGate, NeverAllocates) {
  Gate gate;
  gate.tick(none);
  const test::AllocationCounter counter;
  gate.tick(none), gate.tick(stopping), gate.tick(braking), gate.tick(none, true);
  EXPECT_EQ(counter.count(), 0);
}

TEST(TorqueGate, RefusesLimitsThatAreNotPositive) {
  EXPECT_THROW(TorqueGate({.max_torque = 0.0}), SetupError);
  EXPECT_THROW(TorqueGate({.max_torque_rate = nan}), SetupError);
}

// ---------------------------------------------------------------- recovery

TEST(TorqueGate, RecoversAtAResetWhereOnlyTolerableFaultsAreLeft) {
  for (const bool from_the_start : {false, true}) {
    Gate gate({.max_torque = 10.0, .max_torque_rate = 1e9});
    gate.tolerable = stopping;
    if (!from_the_start) gate.tick(none);
    for (int k = 0; k < 3; ++k) EXPECT_FALSE(gate.tick(stopping).passes());
    EXPECT_FALSE(gate.tick(stopping | braking, true).passes());
    EXPECT_EQ(gate.status().phase, from_the_start ? GatePhase::waiting : GatePhase::closed);
    gate.ticking.set(gate.asked, command(9, -9, 2));
    EXPECT_EQ(gate.tick(stopping, true).phase, GatePhase::recovering);
    EXPECT_EQ(gate.status().reaction, GateReaction::none);
    EXPECT_EQ(gate.status().faults, stopping);
    EXPECT_EQ(gate.torque().torque, Eigen::Vector3d(3, -3, 2));  // 0.3 of the largest torque
    EXPECT_TRUE(gate.status().saturated);
    EXPECT_FALSE(gate.brakes());
  }
}

TEST(TorqueGate, EndsARecoveryThatLeavesWhatIsTolerable) {
  for (const FaultMask found : {stopping | braking, stopping}) {
    Gate gate;
    gate.tick(none);
    gate.tick(stopping);
    gate.tolerable = stopping;
    EXPECT_EQ(gate.tick(stopping, true).phase, GatePhase::recovering);
    if (found == stopping) gate.tolerable = none;
    EXPECT_EQ(gate.tick(found).phase, GatePhase::closed);
    EXPECT_EQ(gate.status().fault,
              found == stopping ? GateFault::workspace_radius : GateFault::station_fault);
    EXPECT_EQ(gate.status().reaction, worst_reaction(found));
  }
}

TEST(TorqueGate, OpensOnceARecoveryHasBeenWithoutFaultsForAWhile) {
  Gate gate;
  gate.tick(none);
  gate.tolerable = stopping;
  gate.tick(stopping);
  gate.tick(stopping, true);
  for (int k = 0; k < 99; ++k) EXPECT_EQ(gate.tick(none).phase, GatePhase::recovering);
  gate.tick(stopping);  // at the limit: once more
  for (int k = 0; k < 99; ++k) EXPECT_EQ(gate.tick(none).phase, GatePhase::recovering);
  EXPECT_EQ(gate.tick(none).phase, GatePhase::open);
}

TEST(TorqueGate, RecoversWithNoCommandThatIsNotUsable) {
  Gate gate;
  gate.tick(none);
  gate.tolerable = stopping;
  gate.tick(stopping);
  gate.tick(stopping, true);
  gate.ticking.set(gate.asked, command(nan, 0, 0));
  EXPECT_EQ(gate.tick(stopping).phase, GatePhase::closed);
  EXPECT_EQ(gate.status().fault, GateFault::command_invalid);
}

}  // namespace
}  // namespace flinch
