#include "drivers/drive_manager.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "drivers/drive_group.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {
namespace {

using enum DriveState;
using Wish = RequestedDriveState::State;

constexpr DriveCondition well{.started = true, .fault = false, .standstill = true};

/// A master that leads three drives with one controlword, as amplifiers on a fieldbus.
class LedDrives {
 public:
  explicit LedDrives(const std::array<DriveState, 3>& states)
      : diagram_(build()), context_(diagram_->make_context()) {
    for (std::size_t i = 0; i < 3; ++i) drives_[i].state = states[i];
  }
  /// One tick, after which the drives have seen the controlword; returns their state together before it.
  DriveState tick(const RequestedDriveState& wish, const DriveCondition& condition = well) {
    Statuswords told{.count = 3};
    for (std::size_t i = 0; i < 3; ++i) told.bits[i] = statusword_of(drives_[i].state);
    context_.set(told_, told);
    context_.set(wish_, wish);
    diagram_->evaluate(context_);
    for (auto& drive : drives_) {
      drive = DriveStateMachine::next(drive, context_.get(controlword_), condition);
    }
    const DriveState before = context_.get(statusword_).state();
    diagram_->update(context_);
    context_.set_time(context_.time() + 1ms);
    return before;
  }

  std::vector<DriveState> states(const RequestedDriveState& wish, int ticks) {
    std::vector<DriveState> seen;
    for (int i = 0; i < ticks; ++i) seen.push_back(tick(wish));
    return seen;
  }

  DriveState of(std::size_t drive) const { return drives_[drive].state; }

 private:
  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder;
    auto& group = builder.add<DriveGroup>("group");
    auto& master = builder.add<DriveManager>("master");
    builder.connect(group.statusword, master.statusword);
    told_ = builder.export_input("told", group.drives);
    wish_ = builder.export_input("wish", master.wish);
    controlword_ = master.controlword;
    statusword_ = group.statusword;
    return builder.build();
  }

  std::array<DriveStateMachine::Memory, 3> drives_;
  InputPort<Statuswords> told_;
  InputPort<RequestedDriveState> wish_;
  OutputPort<Controlword> controlword_;
  OutputPort<Statusword> statusword_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
};

LedDrives all_in(DriveState state) { return LedDrives({state, state, state}); }

TEST(DriveManager, EnablesStepByStep) {
  LedDrives drives = all_in(not_ready_to_switch_on);
  const std::vector<DriveState> expected = {not_ready_to_switch_on, switch_on_disabled,
                                            ready_to_switch_on,     switched_on,
                                            operation_enabled,      operation_enabled};
  EXPECT_EQ(drives.states({.state = Wish::operation_enabled}, 6), expected);
}

TEST(DriveManager, TakesTheVoltageAwayAtOnce) {
  LedDrives drives = all_in(operation_enabled);
  const std::vector<DriveState> expected = {operation_enabled, switch_on_disabled, switch_on_disabled};
  EXPECT_EQ(drives.states({.state = Wish::without_voltage}, 3), expected);
}

TEST(DriveManager, TakesTheTorqueAwayAndLeavesTheVoltage) {
  LedDrives drives = all_in(operation_enabled);
  const std::vector<DriveState> expected = {operation_enabled, switched_on, switched_on};
  EXPECT_EQ(drives.states({.state = Wish::switched_on}, 3), expected);
}

TEST(DriveManager, StopsQuicklyAndStaysThereUntilAllStandStill) {
  constexpr DriveCondition turning{.started = true, .fault = false, .standstill = false};
  LedDrives drives = all_in(operation_enabled);
  drives.tick({.state = Wish::quick_stop}, turning);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(drives.tick({.state = Wish::operation_enabled}, turning), quick_stop_active);
  }
  drives.tick({.state = Wish::quick_stop});
  EXPECT_EQ(drives.tick({.state = Wish::quick_stop}), switch_on_disabled);
}

TEST(DriveManager, BringsDrivesInDifferentStatesToTheSame) {
  constexpr std::array places = {not_ready_to_switch_on, switch_on_disabled, ready_to_switch_on, switched_on,
                                 operation_enabled,      quick_stop_active};
  for (const DriveState a : places) {
    for (const DriveState b : places) {
      for (const DriveState c : places) {
        LedDrives drives({a, b, c});
        drives.states({.state = Wish::operation_enabled}, 8);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(drives.of(i), operation_enabled);
      }
    }
  }
}

TEST(DriveManager, LetsNoDriveRunWhileAnotherHasAFault) {
  LedDrives drives({operation_enabled, fault, operation_enabled});
  for (int i = 0; i < 10; ++i) EXPECT_EQ(drives.tick({.state = Wish::operation_enabled}), fault);
  EXPECT_EQ(drives.of(0), switch_on_disabled);
  EXPECT_EQ(drives.of(2), switch_on_disabled);
}

TEST(DriveManager, ResetsAFaultOnceForEachTimeThatItIsAsked) {
  LedDrives drives({fault, switch_on_disabled, fault});
  const std::vector<DriveState> expected = {fault, switch_on_disabled, switch_on_disabled};
  EXPECT_EQ(drives.states({.state = Wish::without_voltage, .fault_resets = 1}, 3), expected);
}

TEST(DriveManager, DoesNotRepeatAResetThatCameTooEarly) {
  LedDrives drives = all_in(fault);
  constexpr DriveCondition broken{.started = true, .fault = true, .standstill = true};
  drives.tick({.state = Wish::operation_enabled, .fault_resets = 1}, broken);
  for (int i = 0; i < 10; ++i) {  // the drive is well again, but nobody asks once more
    EXPECT_EQ(drives.tick({.state = Wish::operation_enabled, .fault_resets = 1}), fault);
  }
  drives.tick({.state = Wish::operation_enabled, .fault_resets = 2});
  EXPECT_EQ(drives.tick({.state = Wish::operation_enabled, .fault_resets = 2}), switch_on_disabled);
}

TEST(DriveGroup, IsNotReadyWhileNobodyAnswers) {
  DiagramBuilder builder;
  auto& group = builder.add<DriveGroup>("group");
  const auto told = builder.export_input("told", group.drives);
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  diagram->evaluate(context);
  EXPECT_EQ(context.get(group.statusword).state(), not_ready_to_switch_on);
  context.set(told, {.count = 200, .bits = {0x27, 0x27, 0x27, 0x27, 0x27, 0x27}});  // more than there can be
  diagram->evaluate(context);
  EXPECT_EQ(context.get(group.statusword).state(), operation_enabled);
}

}  // namespace
}  // namespace flinch
