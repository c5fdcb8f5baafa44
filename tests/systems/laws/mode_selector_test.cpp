#include "systems/laws/mode_selector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using enum ReactionMode;

TorqueCommand torque(double value, bool valid = true) {
  return {.computed = {}, .valid = valid, .torque = JointVector::Constant(3, value)};
}

PlatformReference reference(double x) {
  const PlatformVector rest = PlatformVector::Zero(3);
  return {.valid = true,
          .finished = true,
          .pose = PlatformVector::Constant(3, x),
          .velocity = rest,
          .acceleration = rest};
}

/// Nominal law 100 Nm, reacting -50 Nm, yielding 20 Nm, zero gravity 10 Nm.
struct Selector {
  explicit Selector(const ModeSelectorSettings& settings = {})
      : block(builder.add<ModeSelector>("selector", settings)),
        reaction(builder.export_input("reaction", block.reaction)),
        nominal_law(builder.export_input("nominal", block.nominal)),
        reaction_law(builder.export_input("reacting", block.reacting)),
        yielding_law(builder.export_input("yielding", block.yielding)),
        gravity_law(builder.export_input("zero_gravity", block.zero_gravity)),
        commanded(builder.export_input("commanded", block.commanded)),
        nominal_reference(builder.export_input("nominal_reference", block.nominal_reference)),
        reaction_reference(builder.export_input("reaction_reference", block.reaction_reference)) {
    ticking.set(nominal_law, torque(100.0));
    ticking.set(reaction_law, torque(-50.0));
    ticking.set(yielding_law, torque(20.0));
    ticking.set(gravity_law, torque(10.0));
    ticking.set(nominal_reference, reference(1.0));
    ticking.set(reaction_reference, reference(2.0));
  }

  /// One tick in this mode.
  const TorqueCommand& tick(ReactionMode mode) {
    if (mode != state.mode) state = {mode, state.mode, ticking.now()};
    ticking.set(reaction, state);
    ticking.tick();
    return ticking.get(block.torque);
  }
  const TorqueCommand& settle(ReactionMode mode) {
    for (int k = 0; k < 20; ++k) tick(mode);
    return ticking.get(block.torque);
  }

  ReactionState state;
  DiagramBuilder builder;
  ModeSelector& block;
  InputPort<ReactionState> reaction;
  InputPort<TorqueCommand> nominal_law, reaction_law, yielding_law, gravity_law, commanded;
  InputPort<PlatformReference> nominal_reference, reaction_reference;
  test::Ticking ticking{builder};
};

TEST(ModeSelector, HandsOnTheTorquesOfTheMode) {
  Selector selector;
  EXPECT_EQ(selector.settle(stopped).torque, torque(10.0).torque);
  EXPECT_EQ(selector.settle(nominal).torque, torque(100.0).torque);
  EXPECT_EQ(selector.settle(react).torque, torque(-50.0).torque);
  EXPECT_EQ(selector.settle(hold).torque, torque(-50.0).torque);
  EXPECT_EQ(selector.settle(zero_g).torque, torque(20.0).torque);
}

TEST(ModeSelector, HandsOnTheReferenceThatIsBeingFollowed) {
  Selector selector;
  const auto followed = [&](ReactionMode mode) {
    selector.tick(mode);
    return selector.ticking.get(selector.block.reference);
  };
  EXPECT_FALSE(followed(stopped).valid);
  EXPECT_EQ(followed(nominal).pose, reference(1.0).pose);
  EXPECT_EQ(followed(react).pose, reference(2.0).pose);
  EXPECT_EQ(followed(hold).pose, reference(2.0).pose);
  EXPECT_FALSE(followed(zero_g).valid);
}

TEST(ModeSelector, BlendsInTenEqualSteps) {
  Selector selector;
  selector.settle(nominal);
  for (int step = 1; step <= 10; ++step) {
    EXPECT_NEAR(selector.tick(react).torque[0], 100.0 - 15.0 * step, 1e-12) << step;
  }
  EXPECT_EQ(selector.tick(react).torque[0], -50.0);
}

TEST(ModeSelector, EvaluatesTheOldLawWhileItBlends) {
  Selector selector({.max_torque_rate = 100e3});
  selector.settle(nominal);
  selector.tick(react);
  selector.ticking.set(selector.nominal_law, torque(200.0));
  EXPECT_NEAR(selector.tick(react).torque[0], 0.8 * 200.0 + 0.2 * -50.0, 1e-12);
}

TEST(ModeSelector, BlendsFromItsFrozenTorqueWhenSwitchedAgain) {
  Selector selector;
  selector.settle(nominal);
  for (int k = 0; k < 4; ++k) selector.tick(react);
  const double frozen = 100.0 - 4 * 15.0;
  selector.ticking.set(selector.nominal_law, torque(1e6));
  for (int step = 1; step <= 10; ++step) {
    EXPECT_NEAR(selector.tick(zero_g).torque[0], frozen + step * (20.0 - frozen) / 10, 1e-12) << step;
  }
}

TEST(ModeSelector, GoesOnBlendingWhenTheModeChangesButNotTheLaw) {
  Selector selector;
  selector.settle(nominal);
  for (int step = 1; step <= 10; ++step) {
    EXPECT_NEAR(selector.tick(step < 4 ? react : hold).torque[0], 100.0 - 15.0 * step, 1e-12) << step;
  }
}

TEST(ModeSelector, NeverStepsByMoreThanATenthOfTheDifference) {
  Selector selector;
  selector.settle(stopped);
  double last = 10.0;
  for (int k = 0; k < 2000; ++k) {
    const ReactionMode mode =
        std::array{nominal, react, zero_g, hold}[static_cast<std::size_t>(k * k / 7 % 4)];
    const double next = selector.tick(mode).torque[0];
    ASSERT_LE(std::abs(next - last), 15.0 + 1e-9) << k;
    last = next;
  }
}

TEST(ModeSelector, BlendsFromItsLastTorqueWhenTheOldLawIsLost) {
  Selector selector;
  selector.settle(nominal);
  selector.ticking.set(selector.nominal_law, torque(0.0, false));
  EXPECT_NEAR(selector.tick(react).torque[0], 0.9 * 100.0 - 0.1 * 50.0, 1e-12);
  EXPECT_NEAR(selector.tick(react).torque[0], 0.8 * 100.0 - 0.2 * 50.0, 1e-12);
}

TEST(ModeSelector, GoesOnFromWhatTheDrivesAreToldInAStop) {
  Selector selector;
  selector.settle(nominal);
  selector.ticking.set(selector.commanded, torque(-60.0));
  selector.tick(nominal);
  EXPECT_EQ(selector.tick(stopped).torque[0], -60.0) << "what was told in the last tick, at once";
  selector.ticking.set(selector.commanded, torque(-55.0));
  EXPECT_EQ(selector.tick(stopped).torque[0], -60.0);
  EXPECT_EQ(selector.tick(stopped).torque[0], -55.0);
  selector.ticking.set(selector.commanded, torque(1e6));
  for (int step = 1; step <= 10; ++step)
    EXPECT_NEAR(selector.tick(nominal).torque[0], -55.0 + 15.5 * step, 1e-12) << step;
}

TEST(ModeSelector, HandsOnZeroGravityInAStopWhereTheDrivesAreToldNothing) {
  Selector selector;
  selector.ticking.set(selector.commanded, torque(-60.0, false));
  EXPECT_EQ(selector.settle(stopped).torque[0], 10.0);
  for (int step = 1; step <= 10; ++step) {
    selector.ticking.set(selector.gravity_law, torque(10.0 + step));
    EXPECT_NEAR(selector.tick(nominal).torque[0], 10.0 * step + (1.0 - 0.1 * step) * (10.0 + step), 1e-12);
  }
}

TEST(ModeSelector, IsNotValidWhereTheNewLawIsNot) {
  Selector selector;
  selector.settle(nominal);
  selector.ticking.set(selector.reaction_law, torque(0.0, false));
  EXPECT_FALSE(selector.tick(react).valid);
  selector.ticking.set(selector.reaction_law, torque(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(selector.tick(react).valid);
}

TEST(ModeSelector, KeepsTheTimeAtWhichTheLawComputed) {
  Selector selector;
  selector.settle(nominal);
  EXPECT_EQ(selector.tick(nominal).computed, Time::zero()) << "so that a law that hangs is detected";
}

TEST(ModeSelector, SwitchesAtOnceWithoutABlend) {
  Selector selector({.blend = 0ms});
  selector.settle(nominal);
  EXPECT_EQ(selector.tick(react).torque[0], -50.0);
}

TEST(ModeSelector, FollowsAReactionThatBeginsAtOnceByTheLargestRate) {
  Selector selector({.reacts_at_once = true, .max_torque_rate = 20e3});
  selector.settle(nominal);
  for (int step = 1; step <= 7; ++step)
    EXPECT_NEAR(selector.tick(react).torque[0], 100.0 - 20.0 * step, 1e-12) << step;
  EXPECT_EQ(selector.tick(react).torque[0], -50.0) << "it has caught up";
  EXPECT_NEAR(selector.tick(zero_g).torque[0], 0.9 * -50.0 + 0.1 * 20.0, 1e-12) << "others are blended in";
  EXPECT_NEAR(selector.tick(react).torque[0], -50.0, 1e-12) << "in the middle of that blend as well";
}

TEST(ModeSelector, NeverAllocates) {
  Selector selector;
  selector.settle(nominal);
  const test::AllocationCounter counter;
  selector.tick(react), selector.tick(zero_g), selector.settle(hold);
  EXPECT_EQ(counter.count(), 0);
}

TEST(ModeSelector, RefusesANegativeBlend) { EXPECT_THROW(ModeSelector({.blend = -1ms}), SetupError); }

// The new law may move while it is blended in.
TEST(ModeSelector, NoBlendChangesTorquesFasterThanDrivesMay) {
  Selector selector({.max_torque_rate = 12e3});
  selector.settle(nominal);
  double before = 100.0, largest = 0.0;
  for (int k = 1; k <= 30; ++k) {
    const double law = std::max(-100.0, 100.0 - 12.0 * k);
    selector.ticking.set(selector.reaction_law, torque(law));
    const double now = selector.tick(react).torque[0];
    largest = std::max(largest, std::abs(now - before));
    before = now;
  }
  EXPECT_NEAR(largest, 12.0, 1e-9);
  EXPECT_NEAR(before, -100.0, 1e-9) << "it catches up";
  selector.ticking.set(selector.reaction_law, torque(100.0));
  EXPECT_EQ(selector.tick(react).torque[0], 100.0) << "afterwards a law is handed on as it is";
}

TEST(ModeSelector, RefusesARateThatIsNotPositive) {
  DiagramBuilder builder("test", 1ms);
  EXPECT_THROW(builder.add<ModeSelector>("selector", ModeSelectorSettings{.max_torque_rate = 0.0}),
               SetupError);
}

}  // namespace
}  // namespace flinch
