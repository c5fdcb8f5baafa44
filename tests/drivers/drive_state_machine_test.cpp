#include "drivers/drive_state_machine.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

using enum DriveState;
using Memory = DriveStateMachine::Memory;

constexpr DriveCondition healthy{.started = true, .fault = false, .standstill = true};
constexpr DriveCondition turning{.started = true, .fault = false, .standstill = false};
constexpr DriveCondition broken{.started = true, .fault = true, .standstill = false};
constexpr DriveCondition broken_at_rest{.started = true, .fault = true, .standstill = true};

DriveState step(Memory& memory, std::uint16_t word, const DriveCondition& drive) {
  memory = DriveStateMachine::next(memory, {word}, drive);
  return memory.state;
}

TEST(DriveStateMachine, IsEnabledStepByStep) {
  Memory drive;
  EXPECT_EQ(step(drive, 0x0f, {.started = false, .fault = false}), not_ready_to_switch_on);
  EXPECT_EQ(step(drive, 0x0f, healthy), switch_on_disabled);
  EXPECT_EQ(step(drive, 0x0f, healthy), switch_on_disabled);
  EXPECT_EQ(step(drive, 0x06, healthy), ready_to_switch_on);
  EXPECT_EQ(step(drive, 0x07, healthy), switched_on);
  EXPECT_EQ(step(drive, 0x0f, healthy), operation_enabled);
}

TEST(DriveStateMachine, GoesFromEveryStateToTheFaultReactionAndThenToFault) {
  for (int state = 0; state < drive_state_count; ++state) {
    Memory drive{static_cast<DriveState>(state), {0x0f}};
    if (drive.state == fault) continue;
    EXPECT_EQ(step(drive, 0x0f, broken), fault_reaction_active);
    EXPECT_EQ(step(drive, 0x0f, broken), fault_reaction_active);
    EXPECT_EQ(step(drive, 0x0f, broken_at_rest), fault);
  }
}

TEST(DriveStateMachine, FaultsBeforeItObeys) {
  Memory drive{operation_enabled, {0x0f}};
  EXPECT_EQ(step(drive, 0x00, broken), fault_reaction_active);
}

TEST(DriveStateMachine, IsResetByAnEdgeOnceTheFaultIsGone) {
  Memory drive{fault, {0x00}};
  EXPECT_EQ(step(drive, 0x80, broken_at_rest), fault);
  EXPECT_EQ(step(drive, 0x80, healthy), fault);  // the bit was set before: no edge
  EXPECT_EQ(step(drive, 0x00, healthy), fault);
  EXPECT_EQ(step(drive, 0x80, healthy), switch_on_disabled);
}

TEST(DriveStateMachine, StaysInAQuickStopUntilItStandsStill) {
  Memory drive{operation_enabled, {0x0f}};
  EXPECT_EQ(step(drive, 0x02, turning), quick_stop_active);
  EXPECT_EQ(step(drive, 0x0f, turning), quick_stop_active);
  EXPECT_EQ(step(drive, 0x0f, healthy), switch_on_disabled);
}

TEST(DriveStateMachine, IsNotReadyAndNotWellUntilItSaysOtherwise) {
  Memory drive;
  EXPECT_EQ(step(drive, 0x06, {}), fault_reaction_active);
}

}  // namespace
}  // namespace flinch
