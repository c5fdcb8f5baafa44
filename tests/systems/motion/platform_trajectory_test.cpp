#include "systems/motion/platform_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

using enum ReactionMode;

const PoseLimits limits{.translation = {1.0, 20.0, 2000.0}, .rotation = {4.0, 80.0, 8000.0}};

PlatformVector pose(double x, double y, double phi) { return Eigen::Vector3d(x, y, phi); }

PlatformPath there_and_back() {
  return PlatformPath::through(*test::planar_rig(), {pose(0, 0, 0), pose(0.1, 0, 0), pose(0, 0, 0)}, limits);
}

struct Nominal {
  explicit Nominal(PlatformTrajectorySettings settings)
      : block(builder.add<PlatformTrajectory>("trajectory", test::planar_rig(), std::move(settings))),
        reaction(builder.export_input("reaction", block.reaction)),
        platform(builder.export_input("platform", block.platform)),
        start(builder.export_input("start", block.start)),
        target(builder.export_input("target", block.target)),
        drive_check(builder.export_input("drive_check", block.drive_check)) {
    at(pose(0, 0, 0));
  }

  void at(const PlatformVector& where, const PlatformVector& velocity = PlatformVector::Zero(3)) {
    ticking.set(platform, {{}, PlatformMotion::Status::valid, where, velocity});
  }
  /// One tick in this mode.
  const PlatformReference& tick(ReactionMode mode = nominal, bool start_now = false) {
    if (mode != state.mode) state = {mode, state.mode, ticking.now()};
    ticking.set(reaction, state);
    ticking.set(start, {.start = start_now});
    ticking.tick();
    return ticking.get(block.reference);
  }
  void go_to(const PlatformVector& where) {
    wanted = {.number = wanted.number + 1, .kind = TargetCommand::Kind::pose, .pose = where, .step = {}};
    ticking.set(target, wanted);
  }
  void go_by(const PlatformVector& step) {
    wanted = {.number = wanted.number + 1, .kind = TargetCommand::Kind::step, .pose = {}, .step = step};
    ticking.set(target, wanted);
  }
  const PlatformReference& reference() const { return ticking.get(block.reference); }

  /// Ticks until the reference has finished; checks that it never jumps.
  void finish() {
    PlatformReference last = reference();
    for (int k = 0; k < 20000; ++k) {
      tick();
      ASSERT_LT((reference().pose - last.pose).norm(), 2e-3);
      ASSERT_LT((reference().velocity - last.velocity).norm(), 0.03);
      last = reference();
      if (last.finished) return;
    }
    FAIL() << "does not finish";
  }

  ReactionState state;
  TargetCommand wanted;
  DiagramBuilder builder;
  PlatformTrajectory& block;
  InputPort<ReactionState> reaction;
  InputPort<PlatformMotion> platform;
  InputPort<StartCommand> start;
  InputPort<TargetCommand> target;
  InputPort<DriveCheckStatus> drive_check;
  test::Ticking ticking{builder};
};

TEST(PlatformTrajectory, IsNotValidBeforeTheNominalModeBegins) {
  Nominal trajectory({.path = there_and_back()});
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(trajectory.tick(stopped).valid);
}

TEST(PlatformTrajectory, HoldsWhereTheRobotIsWithoutAPath) {
  Nominal trajectory({});
  trajectory.at(pose(0.03, 0.04, 0.1));
  for (int k = 0; k < 100; ++k) {
    trajectory.tick();
    trajectory.at(pose(0.5, 0.5, 0.5));  // it does not follow
    EXPECT_TRUE(trajectory.reference().valid);
    EXPECT_TRUE(trajectory.reference().finished);
    EXPECT_EQ(trajectory.reference().pose, pose(0.03, 0.04, 0.1));
    EXPECT_EQ(trajectory.reference().velocity, PlatformVector::Zero(3));
  }
}

TEST(PlatformTrajectory, BringsAMovingRobotToRestWhereItIs) {
  Nominal trajectory({});
  trajectory.at(pose(0, 0, 0), Eigen::Vector3d(0.1, 0, 0));
  EXPECT_NEAR(trajectory.tick().velocity[0], 0.1, 1e-12);
  trajectory.finish();
  EXPECT_EQ(trajectory.reference().pose, pose(0, 0, 0));
}

TEST(PlatformTrajectory, FollowsThePathFromTheStartTimeOn) {
  Nominal trajectory({.path = there_and_back(), .start = 50ms});
  const PlatformPath path = there_and_back();
  for (int k = 0; k < 50; ++k) EXPECT_EQ(trajectory.tick().pose, pose(0, 0, 0)) << k;
  for (int k = 0; k < 1000; ++k) {
    const PlatformReference expected = path.evaluate(1e-3 * k);
    const PlatformReference& now = trajectory.tick();
    ASSERT_LT((now.pose - expected.pose).norm(), 1e-12) << k;
    ASSERT_LT((now.velocity - expected.velocity).norm(), 1e-9) << k;
    ASSERT_LT((now.acceleration - expected.acceleration).norm(), 1e-6) << k;
    ASSERT_EQ(now.finished, expected.finished);
  }
}

TEST(PlatformTrajectory, GoesSlowlyToTheStartOfThePathFirst) {
  Nominal trajectory({.path = there_and_back()});
  trajectory.at(pose(-0.1, 0.05, 0.2));
  EXPECT_EQ(trajectory.tick().pose, pose(-0.1, 0.05, 0.2));
  double fastest = 0.0;
  while ((trajectory.reference().pose - pose(0, 0, 0)).norm() > 1e-9) {
    const PlatformVector last = trajectory.reference().pose;
    trajectory.tick();
    ASSERT_FALSE(trajectory.reference().finished);
    ASSERT_LT((trajectory.reference().pose - last).norm(), 1e-3);
    fastest = std::max(fastest, trajectory.reference().velocity.head(2).norm());
  }
  EXPECT_NEAR(fastest, 0.2, 1e-9);
  trajectory.finish();
  EXPECT_EQ(trajectory.reference().pose, pose(0, 0, 0));
}

TEST(PlatformTrajectory, StartsOnCommandOnlyWhereItHasNoStartTime) {
  Nominal trajectory({.path = there_and_back(), .start = std::nullopt});
  for (int k = 0; k < 100; ++k) EXPECT_EQ(trajectory.tick().pose, pose(0, 0, 0));
  trajectory.tick(nominal, true);
  for (int k = 0; k < 50; ++k) trajectory.tick();
  EXPECT_GT(trajectory.reference().pose[0], 0.01);
}

TEST(PlatformTrajectory, StaysWhereTheRobotIsAfterAnInterruptionUntilStartedAgain) {
  Nominal trajectory({.path = there_and_back()});
  for (int k = 0; k < 100; ++k) trajectory.tick();
  for (int k = 0; k < 100; ++k) trajectory.tick(react);
  trajectory.at(pose(-0.05, 0.02, 0.1));
  for (int k = 0; k < 500; ++k) {
    EXPECT_EQ(trajectory.tick().pose, pose(-0.05, 0.02, 0.1)) << k;
    EXPECT_TRUE(trajectory.reference().finished);
  }
  trajectory.tick(nominal, true);
  trajectory.finish();
  EXPECT_EQ(trajectory.reference().pose, pose(0, 0, 0)) << "the whole path once more";
}

TEST(PlatformTrajectory, DoesNotStartByItselfOnceItWasInterrupted) {
  Nominal trajectory({.path = there_and_back(), .start = 200ms});
  trajectory.tick();
  trajectory.tick(zero_g);
  for (int k = 0; k < 400; ++k) EXPECT_EQ(trajectory.tick().pose, pose(0, 0, 0));
}

TEST(PlatformTrajectory, IgnoresAStartWhileItMovesOrAnotherModeIsActive) {
  Nominal trajectory({.path = there_and_back()}), undisturbed({.path = there_and_back()});
  for (int k = 0; k < 400; ++k) {
    trajectory.tick(nominal, k == 60);
    undisturbed.tick();
    ASSERT_EQ(trajectory.reference().pose, undisturbed.reference().pose) << k;
  }
  for (int k = 0; k < 3; ++k) trajectory.tick(hold, true);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(trajectory.tick().pose, pose(0, 0, 0));
}

TEST(PlatformTrajectory, CanBeRepeatedOnCommand) {
  Nominal trajectory({.path = there_and_back()});
  trajectory.tick();
  trajectory.finish();
  trajectory.tick(nominal, true);
  EXPECT_FALSE(trajectory.reference().finished);
  trajectory.finish();
}

TEST(PlatformTrajectory, IsNotValidWhereThePoseWasNotKnownAsItBegan) {
  Nominal trajectory({.path = there_and_back()});
  trajectory.ticking.set(trajectory.platform, PlatformMotion());
  EXPECT_FALSE(trajectory.tick().valid);
  trajectory.at(pose(0, 0, 0));
  EXPECT_FALSE(trajectory.tick().valid);
  EXPECT_FALSE(trajectory.tick(nominal, true).valid);
  trajectory.tick(stopped);
  EXPECT_TRUE(trajectory.tick().valid);
}

TEST(PlatformTrajectory, IsNotValidAfterAPoseThatIsNoNumber) {
  Nominal trajectory({.path = there_and_back()});
  trajectory.at(pose(0, std::numeric_limits<double>::quiet_NaN(), 0));
  EXPECT_FALSE(trajectory.tick().valid);
}

TEST(PlatformTrajectory, NeverAllocates) {
  Nominal trajectory({.path = there_and_back()});
  trajectory.at(pose(-0.02, 0, 0));
  const test::AllocationCounter counter;
  for (int k = 0; k < 1000; ++k) trajectory.tick();
  trajectory.tick(nominal, true);
  EXPECT_EQ(counter.count(), 0);
}

TEST(PlatformTrajectory, RefusesAnApproachWithoutLimits) {
  EXPECT_THROW(PlatformTrajectory(test::planar_rig(), {.approach = {}}), SetupError);
}

// ---------------------------------------------------------------- targets

TEST(PlatformTrajectory, GoesWhereATargetSaysAndStaysThere) {
  Nominal trajectory({.path = there_and_back(), .start = std::nullopt});
  trajectory.tick();
  trajectory.go_to(pose(0.05, -0.08, 0.2));
  trajectory.finish();
  EXPECT_LT((trajectory.reference().pose - pose(0.05, -0.08, 0.2)).norm(), 1e-12);
  for (int k = 0; k < 50; ++k) EXPECT_TRUE(trajectory.tick().finished);
  trajectory.go_by(pose(0.01, 0.0, -0.1));
  trajectory.tick();
  trajectory.finish();
  EXPECT_LT((trajectory.reference().pose - pose(0.06, -0.08, 0.1)).norm(), 1e-12);
}

TEST(PlatformTrajectory, TurnsToANewTargetOnTheWayWithoutAJump) {
  Nominal trajectory({});
  trajectory.tick();
  trajectory.go_to(pose(0.1, 0.0, 0.0));
  for (int k = 0; k < 300; ++k) trajectory.tick();
  EXPECT_GT(trajectory.reference().velocity[0], 0.1);
  trajectory.go_by(pose(0.0, 0.0, 0.0));  // come to rest
  trajectory.finish();
  trajectory.go_to(pose(0.0, 0.1, 0.0));
  trajectory.tick();
  trajectory.finish();
  EXPECT_LT((trajectory.reference().pose - pose(0.0, 0.1, 0.0)).norm(), 1e-12);
}

// Within the limits of the approach it would come to rest half a metre further.
TEST(PlatformTrajectory, IgnoresATargetWhileItIsFasterThanTheWayThereWouldBe) {
  Nominal trajectory({.path = there_and_back(), .start = Time::zero()});
  Nominal undisturbed({.path = there_and_back(), .start = Time::zero()});
  double fastest = 0.0;
  for (int k = 0; k < 400; ++k) {
    trajectory.tick();
    undisturbed.tick();
    const double speed = trajectory.reference().velocity.head(2).norm();
    fastest = std::max(fastest, speed);
    if (speed > 0.3) trajectory.go_to(pose(0.0, 0.0, 0.0));
    EXPECT_EQ(trajectory.reference().pose, undisturbed.reference().pose);
  }
  EXPECT_GT(fastest, 0.5);
}

TEST(PlatformTrajectory, IgnoresTargetsThatAreNone) {
  Nominal trajectory({});
  trajectory.go_to(pose(0.1, 0.0, 0.0));  // before it may move
  trajectory.tick(stopped);
  for (int k = 0; k < 10; ++k) trajectory.tick();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  trajectory.go_to(pose(5.0, 0.0, 0.0));  // out of reach
  trajectory.tick();
  trajectory.go_to(pose(nan, 0.0, 0.0));
  trajectory.tick();
  trajectory.go_to(PlatformVector());
  trajectory.tick();
  trajectory.go_by(pose(0.0, nan, 0.0));
  trajectory.tick();
  trajectory.go_by(PlatformVector::Zero(2));
  trajectory.tick();
  trajectory.go_to(pose(0.1, 0.0, 0.0));
  trajectory.tick(react);  // while it gives way
  for (int k = 0; k < 10; ++k) EXPECT_EQ(trajectory.tick().pose, pose(0, 0, 0));
}

TEST(PlatformTrajectory, RecoversSlowlyAndGoesOnInTheNominalMode) {
  PlatformTrajectorySettings settings{.path = there_and_back()};  // would start by itself
  Nominal trajectory(settings);
  trajectory.at(pose(0.1, 0.0, 0.0));
  for (int k = 0; k < 100; ++k) EXPECT_EQ(trajectory.tick(recover).pose, pose(0.1, 0.0, 0.0));
  trajectory.go_to(pose(0.0, 0.0, 0.0));
  double fastest = 0.0;
  for (int k = 0; k < 1000; ++k) fastest = std::max(fastest, trajectory.tick(recover).velocity.norm());
  EXPECT_NEAR(fastest, settings.recovery.translation.velocity, 1e-12);
  const PlatformVector before = trajectory.reference().pose;
  EXPECT_LT((trajectory.tick(nominal).pose - before).norm(), 1e-4);
  trajectory.finish();
  EXPECT_LT((trajectory.reference().pose - pose(0, 0, 0)).norm(), 1e-12);
}

TEST(PlatformTrajectory, StartsOnceTheDrivesHaveBeenChecked) {
  using Phase = DriveCheckStatus::Phase;
  for (const bool pressed : {false, true}) {
    PlatformTrajectorySettings settings{.path = there_and_back()};
    if (pressed) settings.start = std::nullopt;
    Nominal motion(settings);
    motion.ticking.set(motion.drive_check, {.phase = Phase::running, .drive = 0, .gain = {}});
    motion.tick();
    motion.tick(nominal, pressed);
    for (int k = 0; k < 50; ++k) motion.tick();
    EXPECT_TRUE(motion.reference().finished) << "nothing moves before";
    motion.ticking.set(motion.drive_check, {.phase = Phase::passed, .drive = 2, .gain = {}});
    for (int k = 0; k < 50; ++k) motion.tick();
    EXPECT_FALSE(motion.reference().finished) << "it has begun";
  }
}

}  // namespace
}  // namespace flinch
