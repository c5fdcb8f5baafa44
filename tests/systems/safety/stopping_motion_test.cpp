#include "systems/safety/stopping_motion.h"

#include <gtest/gtest.h>

#include "systems/safety/fault_table.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr GateStatus opened{.phase = GatePhase::open, .reaction = GateReaction::none};

struct Stopping {
  Stopping() {
    ticking.set(motion, posture.platform);
    tick(0, opened);
  }

  bool tick(FaultMask present, const GateStatus& gate_then) {
    ticking.set(faults, FaultReport{.valid = true, .present = present});
    ticking.set(gate, gate_then);
    ticking.tick();
    return ticking.get(block.trusted).valid();
  }

  test::Posture posture{*test::planar_rig(), Eigen::Vector3d(0.1, 0.0, 0.0)};
  DiagramBuilder builder{"test", 1ms};
  StoppingMotion& block = builder.add<StoppingMotion>("stopping");
  InputPort<PlatformMotion> motion = builder.export_input("motion", block.motion);
  InputPort<FaultReport> faults = builder.export_input("faults", block.faults);
  InputPort<GateStatus> gate = builder.export_input("gate", block.gate);
  test::Ticking ticking{builder};
};

GateStatus closed_by(FaultMask faults) {
  return {.phase = GatePhase::closed, .reaction = worst_reaction(faults), .faults = faults};
}

TEST(StoppingMotion, IsThereFromTheTickOfTheFaultUntilTheGateOpens) {
  const FaultMask fault = fault_bit(GateFault::operator_stop);
  Stopping stopping;
  EXPECT_FALSE(stopping.tick(0, opened));
  EXPECT_TRUE(stopping.tick(fault, closed_by(fault)));
  EXPECT_EQ(stopping.ticking.get(stopping.block.trusted).pose, stopping.posture.platform.pose);
  EXPECT_TRUE(stopping.tick(0, closed_by(fault))) << "what closed the gate counts for as long";
  EXPECT_TRUE(stopping.tick(0, opened));
  EXPECT_FALSE(stopping.tick(0, opened));
}

TEST(StoppingMotion, IsNotThereOnceAnythingIsInDoubt) {
  const FaultMask trusted = fault_bit(GateFault::operator_stop);
  for (const FaultRow& row : fault_table()) {
    Stopping stopping;
    const FaultMask fault = fault_bit(row.fault);
    EXPECT_EQ(stopping.tick(fault, closed_by(fault)), row.doubt == Doubt::nothing) << row.description;
    EXPECT_EQ(stopping.tick(trusted, closed_by(fault | trusted)), row.doubt == Doubt::nothing)
        << "what has been doubted stays in doubt: " << row.description;
  }
}

TEST(StoppingMotion, IsNotThereWhereNoControlledStopCanFollow) {
  const FaultMask fault = fault_bit(GateFault::operator_stop);
  GateStatus braked = closed_by(fault);
  braked.reaction = GateReaction::zero_torque_and_brake;
  for (const GateStatus& before : {GateStatus(), braked}) {
    Stopping stopping;
    stopping.tick(0, before);
    EXPECT_FALSE(stopping.tick(fault, before));
  }
  Stopping stopping;
  stopping.tick(0, {.phase = GatePhase::recovering, .reaction = GateReaction::none, .faults = fault});
  EXPECT_TRUE(stopping.tick(fault, closed_by(fault)));
}

TEST(StoppingMotion, IsNotThereWhereNobodyHasLookedForFaults) {
  Stopping stopping;
  stopping.ticking.set(stopping.faults, FaultReport{.present = fault_bit(GateFault::operator_stop)});
  stopping.ticking.tick();
  EXPECT_FALSE(stopping.ticking.get(stopping.block.trusted).valid());
}

TEST(StoppingMotion, NeverAllocates) {
  Stopping stopping;
  const test::AllocationCounter counter;
  stopping.ticking.tick();
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
