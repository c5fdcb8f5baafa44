#include "drivers/drive_state.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace flinch {
namespace {

using enum DriveState;
using enum DriveCommand;

// The table of the standard, written once more and as a whole: rows are states, columns commands in the order
// of DriveCommand; a state that a command may not leave stands there itself.
struct Row {
  DriveState from;
  std::array<DriveState, drive_command_count> to;
};

constexpr DriveState nr = not_ready_to_switch_on, sod = switch_on_disabled, rtso = ready_to_switch_on,
                     so = switched_on, oe = operation_enabled, qs = quick_stop_active,
                     fr = fault_reaction_active, f = fault;
constexpr Row table[] = {
    // none shutdown switch_on enable disable_voltage quick_stop fault_reset
    {nr, {nr, nr, nr, nr, nr, nr, nr}},           //
    {sod, {sod, rtso, sod, sod, sod, sod, sod}},  //
    {rtso, {rtso, rtso, so, rtso, sod, sod, rtso}},
    {so, {so, rtso, so, oe, sod, sod, so}},
    {oe, {oe, rtso, so, oe, sod, qs, oe}},
    {qs, {qs, qs, qs, qs, sod, qs, qs}},
    {fr, {fr, fr, fr, fr, fr, fr, fr}},
    {f, {f, f, f, f, f, f, sod}},
};

TEST(DriveState, ChangesByEachCommandAsTheStandardSaysAndOtherwiseNot) {
  ASSERT_EQ(std::size(table), static_cast<std::size_t>(drive_state_count));
  for (const Row& row : table) {
    for (int command = 0; command < drive_command_count; ++command) {
      EXPECT_EQ(after(row.from, static_cast<DriveCommand>(command)),
                row.to[static_cast<std::size_t>(command)])
          << "state " << static_cast<int>(row.from) << ", command " << command;
    }
  }
}

TEST(DriveState, IsReadBackFromItsStatuswordWhateverTheOtherBitsSay) {
  for (int state = 0; state < drive_state_count; ++state) {
    const std::uint16_t word = statusword_of(static_cast<DriveState>(state));
    for (const int others : {0x0000, 0x0010, 0x0080, 0xff00, 0xff90}) {
      EXPECT_EQ(state_in(static_cast<std::uint16_t>(word | others)), static_cast<DriveState>(state));
    }
  }
}

TEST(DriveState, OfANonsensicalStatuswordIsAFault) {
  EXPECT_EQ(state_in(0x02), fault);
  EXPECT_EQ(state_in(0x2f & ~0x08), operation_enabled);
  EXPECT_EQ(state_in(0x49), fault);
}

TEST(DriveCommand, IsReadBackFromItsControlword) {
  for (const DriveCommand command :
       {shutdown, switch_on, enable_operation, disable_voltage, quick_stop, fault_reset}) {
    EXPECT_EQ(command_in(controlword_for(command), 0), command);
  }
}

TEST(DriveCommand, OfEveryControlwordIsWhatTheTableOfBitsSays) {
  for (int word = 0; word < 0x80; ++word) {
    const bool on = (word & 1) != 0, voltage = (word & 2) != 0, no_quick_stop = (word & 4) != 0,
               enable = (word & 8) != 0;
    const DriveCommand expected = !voltage         ? disable_voltage
                                  : !no_quick_stop ? quick_stop
                                  : !on            ? shutdown
                                  : enable         ? enable_operation
                                                   : switch_on;
    EXPECT_EQ(command_in(static_cast<std::uint16_t>(word), 0), expected) << std::hex << word;
  }
}

TEST(DriveCommand, ResetsAFaultOnlyAtTheRisingEdge) {
  EXPECT_EQ(command_in(0x8f, 0x0f), fault_reset);
  EXPECT_EQ(command_in(0x8f, 0x8f), none);
  EXPECT_EQ(command_in(0x80, 0x80), none);
}

TEST(DriveCommand, LeadsStepByStepToAnyStateThatCanBeAskedFor) {
  for (const DriveState wanted : {sod, rtso, so, oe}) {
    for (const DriveState start : {sod, rtso, so, oe}) {
      DriveState state = start;
      for (int step = 0; step < 3; ++step) state = after(state, step_towards(wanted, state));
      EXPECT_EQ(state, wanted) << "from " << static_cast<int>(start);
      EXPECT_EQ(step_towards(wanted, state), none);
    }
  }
  EXPECT_EQ(step_towards(qs, oe), quick_stop);
}

TEST(DriveCommand, NeverResetsAFaultByItself) {
  for (const DriveState wanted : {sod, rtso, so, oe, qs}) {
    EXPECT_EQ(step_towards(wanted, f), none);
    EXPECT_EQ(step_towards(wanted, fr), none);
  }
}

TEST(DrivesTogether, AreInTheOnlyStateThatAllOfThemHave) {
  for (const DriveState state : {nr, sod, rtso, so, oe, qs, fr, f}) EXPECT_EQ(together(state, state), state);
}

TEST(DrivesTogether, DoNotDependOnTheirOrder) {
  for (const DriveState a : {nr, sod, rtso, so, oe, qs, fr, f}) {
    for (const DriveState b : {nr, sod, rtso, so, oe, qs, fr, f}) {
      EXPECT_EQ(together(a, b), together(b, a));
      for (const DriveState c : {nr, sod, rtso, so, oe, qs, fr, f}) {
        EXPECT_EQ(together(together(a, b), c), together(a, together(b, c)));
      }
    }
  }
}

TEST(DrivesTogether, AreAsFarUpAsTheLowestAndFaultyOnceAllHaveReacted) {
  EXPECT_EQ(together(oe, so), so);
  EXPECT_EQ(together(so, rtso), rtso);
  EXPECT_EQ(together(rtso, sod), sod);
  EXPECT_EQ(together(oe, qs), qs);
  EXPECT_EQ(together(sod, qs), qs);
  for (const DriveState other : {nr, sod, rtso, so, oe, qs, f}) {
    EXPECT_EQ(together(f, other), f);
    EXPECT_EQ(together(fr, other), fr);
  }
}

}  // namespace
}  // namespace flinch
