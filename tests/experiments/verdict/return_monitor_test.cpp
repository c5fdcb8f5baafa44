#include "experiments/verdict/return_monitor.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

using enum ReactionMode;

/// Samples, one a millisecond, of a robot that is in its nominal motion unless it is said otherwise.
class Samples {
 public:
  Samples() {
    now_.mode = nominal;
    now_.gate.phase = GatePhase::open;
    now_.reference_valid = true;
  }

  Samples& is(ReactionMode mode, bool rests, double speed = 0.0, int samples = 3) {
    now_.mode = mode;
    now_.gate.phase = GatePhase::open;
    if (mode == stopped) now_.gate.phase = GatePhase::closed;
    if (mode == recover) now_.gate.phase = GatePhase::recovering;
    now_.reference_rests = rests;
    now_.speed = speed;
    return go_on(samples);
  }
  /// At the next sample at which the gate is closed.
  Samples& fails(GateFault fault) {
    now_.gate.fault = fault;
    return *this;
  }
  Samples& closes(GateFault fault) { return fails(fault).is(stopped, true); }
  /// A button that is down at one sample, after which the robot is like this.
  Samples& presses(const OperatorCommand& button, ReactionMode mode, bool rests) {
    now_.pressed = button;
    is(mode, rests, 0.0, 1);
    now_.pressed = {};
    return *this;
  }
  Samples& resets(ReactionMode mode) { return presses({.reset = true}, mode, true); }
  Samples& starts(bool rests = false) { return presses({.start = true}, nominal, rests); }

  const std::optional<Return>& seen() const { return watch_.seen(); }

 private:
  Samples& go_on(int samples) {
    for (int k = 0; k < samples; ++k) {
      watch_.see(now_);
      now_.time += 1e-3;
    }
    return *this;
  }

  RunSample now_;
  ReturnMonitor watch_;
};

TEST(AReturn, IsNoneWhereNothingWasInterrupted) {
  EXPECT_FALSE(Samples().is(nominal, false).is(react, false).is(hold, true).seen());
  EXPECT_FALSE(Samples().is(nominal, true).resets(nominal).starts().seen());
}

TEST(AReturn, LeadsFromAHoldToAMotionThatIsStarted) {
  Samples samples;
  samples.is(nominal, false).is(react, false, 0.9).is(hold, true).resets(nominal);
  ASSERT_TRUE(samples.seen());
  EXPECT_EQ(samples.seen()->from, "hold");
  EXPECT_EQ(samples.seen()->stopped_by, "");
  EXPECT_NEAR(samples.seen()->reset, 0.009, 1e-12);
  EXPECT_FALSE(samples.seen()->resumed);
  samples.is(nominal, true, 0.01).starts().is(nominal, false, 1.0);
  EXPECT_NEAR(samples.seen()->resumed.value(), 0.013, 1e-12);
  EXPECT_EQ(samples.seen()->resets, 1);
  EXPECT_EQ(samples.seen()->reactions, 0);
  EXPECT_EQ(samples.seen()->nominal_speed, 0.01) << "what comes after it is its own";
  EXPECT_EQ(samples.seen()->recovery_speed, 0.0);
  EXPECT_EQ(samples.seen()->fault, "");
}

TEST(AReturn, TellsWhatStoppedTheRobotAndHowFastItCameBack) {
  Samples samples;
  samples.is(nominal, false).closes(GateFault::workspace_radius).resets(stopped).is(recover, false, 0.05);
  samples.is(nominal, false, 0.04).is(nominal, true).starts();
  ASSERT_TRUE(samples.seen());
  EXPECT_EQ(samples.seen()->from, "stopped");
  EXPECT_EQ(samples.seen()->stopped_by, "the platform is too far out");
  EXPECT_TRUE(samples.seen()->resumed);
  EXPECT_EQ(samples.seen()->recovery_speed, 0.05);
  EXPECT_EQ(samples.seen()->nominal_speed, 0.04);
  EXPECT_EQ(samples.seen()->fault, "");
}

TEST(AReturn, CountsResetsReactionsAndFaultsOnTheWay) {
  Samples samples;
  samples.is(nominal, false).is(zero_g, true).resets(zero_g).is(zero_g, true).resets(nominal);
  samples.is(react, false).is(hold, true).resets(nominal).closes(GateFault::operator_stop).resets(nominal);
  EXPECT_EQ(samples.seen()->from, "zero_g");
  EXPECT_EQ(samples.seen()->resets, 4);
  EXPECT_EQ(samples.seen()->reactions, 1);
  EXPECT_EQ(samples.seen()->fault, "the operator stops the robot");
}

TEST(AReturn, TellsOfAGateThatClosesAtTheReset) {
  Samples samples;
  samples.is(nominal, false).is(hold, true).fails(GateFault::operator_stop).resets(stopped);
  ASSERT_TRUE(samples.seen());
  EXPECT_EQ(samples.seen()->from, "hold");
  EXPECT_EQ(samples.seen()->fault, "the operator stops the robot");
}

TEST(AReturn, NeedsAStartThatMovesARobotAtRest) {
  Samples samples;
  samples.is(nominal, false).is(hold, true).resets(nominal).starts(true).is(nominal, true);
  EXPECT_FALSE(samples.seen()->resumed) << "the start led nowhere";
  samples.is(nominal, false).starts();
  EXPECT_FALSE(samples.seen()->resumed) << "it was on its way to a target";
}

TEST(AReturn, IsJudgedByAButtonThatGoesDown) {
  Samples samples;
  samples.presses({.reset = true}, stopped, true);
  EXPECT_FALSE(samples.seen()) << "it was down from the start";
}

}  // namespace
}  // namespace flinch
