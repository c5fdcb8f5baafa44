#include "systems/laws/reaction_sequence.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using enum ReactionMode;

constexpr std::array modes{stopped, nominal, react, hold, zero_g, recover};

// ---------------------------------------------------------------- every mode under every combination of
// events

struct Transition {
  ReactionMode from;
  ReactionMode to;
};

bool operator<(const Transition& a, const Transition& b) {
  return std::pair(a.from, a.to) < std::pair(b.from, b.to);
}

/// The only transitions that exist, and what each needs, written out independently of next_mode().
using Needs = bool (*)(const ReactionEvents&);
const std::map<Transition, Needs> legal{
    {{stopped, nominal}, [](const ReactionEvents& e) { return e.gate_open && !e.struck; }},
    {{stopped, zero_g}, [](const ReactionEvents& e) { return e.gate_open && e.struck; }},
    {{nominal, stopped}, [](const ReactionEvents& e) { return !e.gate_open; }},
    {{nominal, react}, [](const ReactionEvents& e) { return e.gate_open && !e.struck && e.touched; }},
    {{nominal, zero_g}, [](const ReactionEvents& e) { return e.gate_open && e.struck; }},
    {{react, stopped}, [](const ReactionEvents& e) { return !e.gate_open; }},
    {{react, hold}, [](const ReactionEvents& e) { return e.gate_open && !e.struck && e.arrived; }},
    {{react, zero_g}, [](const ReactionEvents& e) { return e.gate_open && e.struck; }},
    {{hold, stopped}, [](const ReactionEvents& e) { return !e.gate_open; }},
    {{hold, react},
     [](const ReactionEvents& e) { return e.gate_open && !e.struck && !e.reset && e.goes_on; }},
    {{hold, nominal}, [](const ReactionEvents& e) { return e.gate_open && !e.struck && e.reset; }},
    {{hold, zero_g}, [](const ReactionEvents& e) { return e.gate_open && e.struck; }},
    {{zero_g, stopped}, [](const ReactionEvents& e) { return !e.gate_open; }},
    {{zero_g, nominal},
     [](const ReactionEvents& e) { return e.gate_open && !e.struck && e.reset && e.quiet; }},
    {{recover, stopped}, [](const ReactionEvents& e) { return !e.gate_open; }},
    {{recover, nominal}, [](const ReactionEvents& e) { return e.gate_open && !e.struck; }},
    {{recover, zero_g}, [](const ReactionEvents& e) { return e.gate_open && e.struck; }},
};

ReactionEvents events_from_bits(unsigned bits) {
  return {.gate_open = (bits & 1U) != 0,
          .touched = (bits & 2U) != 0,
          .struck = (bits & 4U) != 0,
          .arrived = (bits & 8U) != 0,
          .goes_on = (bits & 32U) != 0,
          .quiet = (bits & 16U) != 0,
          .reset = (bits & 64U) != 0};
}

TEST(NextMode, MakesEveryLegalTransitionAndNoOther) {
  for (const ReactionMode from : modes) {
    for (unsigned bits = 0; bits < 128; ++bits) {
      const ReactionEvents events = events_from_bits(bits);
      const ReactionMode next = next_mode(from, events);
      for (const ReactionMode to : modes) {
        if (to == from) continue;
        const auto rule = legal.find({from, to});
        const bool wanted = rule != legal.end() && rule->second(events);
        EXPECT_EQ(next == to, wanted) << "from " << int(from) << " to " << int(to) << " with events " << bits;
      }
    }
  }
}

TEST(NextMode, RecoversWhateverElseHappens) {
  for (const ReactionMode from : modes) {
    for (unsigned bits = 0; bits < 128; ++bits) {
      ReactionEvents events = events_from_bits(bits);
      events.recovering = true;
      EXPECT_EQ(next_mode(from, events), recover);
    }
  }
}

TEST(NextMode, LeavesAReactionOnlyByReset) {
  for (unsigned bits = 0; bits < 64; ++bits) {
    for (const ReactionMode from : {react, hold, zero_g}) {
      EXPECT_NE(next_mode(from, events_from_bits(bits)), nominal);
    }
  }
}

// ---------------------------------------------------------------- the block

struct Sequence {
  explicit Sequence(const ReactionSequenceSettings& settings = {})
      : block(builder.add<ReactionSequence>("sequence", settings)),
        detection(builder.export_input("detection", block.detection)),
        joints(builder.export_input("joints", block.joints)),
        reaction(builder.export_input("reaction", block.reaction)),
        gate(builder.export_input("gate", block.gate)),
        reset(builder.export_input("reset", block.reset)) {
    set_gate(GatePhase::open);
    set_level(ContactLevel::none);
    set_speed(0.0);
    set_finished(false);
    ticking.set(reset, {});
  }

  void set_gate(GatePhase phase) { ticking.set(gate, {.phase = phase}); }
  void set_level(ContactLevel level, bool valid = true) {
    ticking.set(detection, {.valid = valid, .level = level, .present_level = level, .wrench_in_base = {}});
  }
  void set_speed(double speed) {
    ticking.set(
        joints,
        {.valid = true, .position = Eigen::Vector3d::Zero(), .velocity = Eigen::Vector3d(0, -speed, 0)});
  }
  void set_finished(bool finished, bool valid = true) {
    ticking.set(reaction,
                {.valid = valid, .finished = finished, .pose = {}, .velocity = {}, .acceleration = {}});
  }
  const ReactionState& tick(bool reset_now = false) {
    ticking.set(reset, {.reset = reset_now});
    ticking.tick();
    return ticking.get(block.reaction_state);
  }
  void go_to_hold() {
    tick(), tick();
    set_level(ContactLevel::reaction);
    tick();
    set_level(ContactLevel::none);
    set_finished(true);
    tick(), tick();
  }

  DiagramBuilder builder;
  ReactionSequence& block;
  InputPort<ContactDetection> detection;
  InputPort<JointMotion> joints;
  InputPort<PlatformReference> reaction;
  InputPort<GateStatus> gate;
  InputPort<ResetCommand> reset;
  test::Ticking ticking{builder};
};

TEST(ReactionSequence, BeginsStoppedAndTurnsNominalATickAfterTheGateOpened) {
  Sequence sequence;
  sequence.set_gate(GatePhase::waiting);
  EXPECT_EQ(sequence.tick().mode, stopped);
  EXPECT_EQ(sequence.tick().mode, stopped);
  sequence.set_gate(GatePhase::open);
  EXPECT_EQ(sequence.tick().mode, stopped);
  const ReactionState& state = sequence.tick();
  EXPECT_EQ(state.mode, nominal);
  EXPECT_EQ(state.previous, stopped);
  EXPECT_EQ(state.since, 3ms);
}

TEST(ReactionSequence, ReactsAtTheTickOfTheDetection) {
  Sequence sequence;
  sequence.tick(), sequence.tick();
  sequence.set_level(ContactLevel::reaction);
  const ReactionState& state = sequence.tick();
  EXPECT_EQ(state.mode, react);
  EXPECT_EQ(state.previous, nominal);
  EXPECT_EQ(state.since, 2ms);
}

TEST(ReactionSequence, KeepsTheTimeOfTheTransitionAsLongAsTheModeLasts) {
  Sequence sequence;
  sequence.go_to_hold();
  const Time since = sequence.tick().since;
  for (int k = 0; k < 50; ++k) EXPECT_EQ(sequence.tick().since, since);
}

TEST(ReactionSequence, HoldsATickAfterTheReactionMotionArrived) {
  Sequence sequence;
  sequence.tick(), sequence.tick();
  sequence.set_level(ContactLevel::reaction);
  EXPECT_EQ(sequence.tick().mode, react);
  sequence.set_finished(true);
  EXPECT_EQ(sequence.tick().mode, react);
  EXPECT_EQ(sequence.tick().mode, hold);
}

TEST(ReactionSequence, IsNotMovedByTheEndOfAnEarlierReaction) {
  Sequence sequence;
  sequence.go_to_hold();
  sequence.tick(true);
  sequence.set_level(ContactLevel::reaction);
  sequence.set_finished(false);  // planned anew at this tick
  EXPECT_EQ(sequence.tick().mode, react);
  EXPECT_EQ(sequence.tick().mode, react);
}

TEST(ReactionSequence, StaysInHoldThroughFurtherContactsUntilReset) {
  Sequence sequence;
  sequence.go_to_hold();
  sequence.set_level(ContactLevel::reaction);
  EXPECT_EQ(sequence.tick().mode, hold);
  sequence.set_level(ContactLevel::none);
  EXPECT_EQ(sequence.tick().mode, hold);
  EXPECT_EQ(sequence.tick(true).mode, nominal);
}

TEST(ReactionSequence, StaysInHoldWhenNothingIsKnownOfTheReaction) {
  Sequence sequence;
  sequence.go_to_hold();
  sequence.set_finished(false, false);
  sequence.tick();
  EXPECT_EQ(sequence.tick().mode, hold);
}

TEST(ReactionSequence, GivesWayAgainATickAfterTheReactionGoesOn) {
  Sequence sequence;
  sequence.go_to_hold();
  sequence.set_finished(false);
  EXPECT_EQ(sequence.tick().mode, hold);
  const ReactionState& state = sequence.tick();
  EXPECT_EQ(state.mode, react);
  EXPECT_EQ(state.previous, hold);
  sequence.set_finished(true);
  sequence.tick();
  EXPECT_EQ(sequence.tick().mode, hold);
}

TEST(ReactionSequence, LeavesZeroGravityOnlyWhenFreeOfContactAndAtRest) {
  Sequence sequence;
  sequence.tick(), sequence.tick();
  sequence.set_level(ContactLevel::hard);
  EXPECT_EQ(sequence.tick().mode, zero_g);
  EXPECT_EQ(sequence.tick(true).mode, zero_g) << "hard contact";
  sequence.set_level(ContactLevel::reaction);
  EXPECT_EQ(sequence.tick(true).mode, zero_g) << "contact";
  sequence.set_level(ContactLevel::none, false);
  EXPECT_EQ(sequence.tick(true).mode, zero_g) << "contact not known";
  sequence.set_level(ContactLevel::none);
  sequence.set_speed(0.06);
  EXPECT_EQ(sequence.tick(true).mode, zero_g) << "moving";
  sequence.set_speed(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(sequence.tick(true).mode, zero_g) << "not known whether moving";
  sequence.set_speed(0.04);
  EXPECT_EQ(sequence.tick(false).mode, zero_g) << "no reset";
  EXPECT_EQ(sequence.tick(true).mode, nominal);
}

TEST(ReactionSequence, TreatsAHardContactAsAnyOtherWhereZeroGravityIsSwitchedOff) {
  Sequence sequence({.zero_g_when_struck = false});
  sequence.tick(), sequence.tick();
  sequence.set_level(ContactLevel::hard);
  EXPECT_EQ(sequence.tick().mode, react);
  EXPECT_EQ(sequence.tick().mode, react);
}

TEST(ReactionSequence, IgnoresTheLevelOfAnInvalidDetection) {
  Sequence sequence;
  sequence.tick(), sequence.tick();
  sequence.set_level(ContactLevel::hard, false);
  EXPECT_EQ(sequence.tick().mode, nominal);
}

TEST(ReactionSequence, FollowsTheGateFromAnyMode) {
  for (const ContactLevel level : {ContactLevel::none, ContactLevel::reaction, ContactLevel::hard}) {
    Sequence sequence;
    sequence.tick(), sequence.tick();
    sequence.set_level(level);
    sequence.tick();
    sequence.set_gate(GatePhase::closed);
    sequence.tick();
    EXPECT_EQ(sequence.tick().mode, stopped);
    EXPECT_EQ(sequence.tick(true).mode, stopped);
  }
}

TEST(ReactionSequence, NeverAllocates) {
  Sequence sequence;
  sequence.go_to_hold();
  const test::AllocationCounter counter;
  sequence.tick(true);
  for (int k = 0; k < 10; ++k) sequence.tick();
  EXPECT_EQ(counter.count(), 0);
}

TEST(ReactionSequence, RefusesARestSpeedThatIsNotPositive) {
  EXPECT_THROW(ReactionSequence({.rest_speed = 0.0}), SetupError);
  EXPECT_THROW(ReactionSequence({.rest_speed = std::numeric_limits<double>::quiet_NaN()}), SetupError);
}

}  // namespace
}  // namespace flinch
