#include "systems/motion/retraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double T = 1e-3;

PlatformMotion moving(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) {
  return {{}, PlatformMotion::Status::valid, pose, velocity};
}

WrenchEstimate pushed(const Eigen::Vector3d& wrench, bool valid = true) {
  return {.acquired = {}, .valid = valid, .wrench_in_base = wrench, .drive_torque = {}};
}

struct Reflex {
  explicit Reflex(const RetractionSettings& settings = {})
      : block(builder.add<Retraction>("retraction", test::planar_rig(), settings)),
        reaction(builder.export_input("reaction", block.reaction)),
        platform(builder.export_input("platform", block.platform)),
        estimate(builder.export_input("estimate", block.estimate)) {
    state = {ReactionMode::nominal, ReactionMode::stopped, {}};
  }

  /// One tick with all inputs as they were set.
  const PlatformReference& tick() {
    ticking.set(reaction, state);
    ticking.tick();
    return ticking.get(block.reference);
  }
  /// The tick at which the contact is detected.
  const PlatformReference& detect(const PlatformMotion& motion, const WrenchEstimate& contact) {
    state = {ReactionMode::react, ReactionMode::nominal, ticking.now()};
    ticking.set(platform, motion);
    ticking.set(estimate, contact);
    return tick();
  }
  const PlatformReference& finish() {
    for (int k = 0; k < 5000 && !ticking.get(block.reference).finished; ++k) tick();
    return ticking.get(block.reference);
  }

  ReactionState state;
  DiagramBuilder builder;
  Retraction& block;
  InputPort<ReactionState> reaction;
  InputPort<PlatformMotion> platform;
  InputPort<WrenchEstimate> estimate;
  test::Ticking ticking{builder};
};

// ---------------------------------------------------------------- where to

TEST(RetractionDisplacement, IsAlongTheForceHoweverStrongItIs) {
  const PlatformVector d = retraction_displacement(Eigen::Vector3d(-30.0, 40.0, 2.0), 2, {});
  EXPECT_NEAR((d - PlatformVector(Eigen::Vector3d(-0.06, 0.08, 0.0))).norm(), 0.0, 1e-15);
}

TEST(RetractionDisplacement, TurnsWithAMomentThatComesWithoutAForce) {
  const RetractionSettings settings{.angle = 0.2};
  EXPECT_EQ(retraction_displacement(Eigen::Vector3d(2.0, -2.0, -1.3), 2, settings),
            Eigen::Vector3d(0.0, 0.0, -0.2));
}

TEST(RetractionDisplacement, GoesByAForceAsSoonAsItIsStrongEnough) {
  EXPECT_NE(retraction_displacement(Eigen::Vector3d(3.0, 0.0, 1.5), 2, {})[0], 0.0);
  EXPECT_EQ(retraction_displacement(Eigen::Vector3d(2.9, 0.0, 1.5), 2, {})[0], 0.0);
}

TEST(RetractionDisplacement, IsNoneForNothing) {
  EXPECT_EQ(retraction_displacement(Eigen::Vector3d::Zero(), 2, {}), Eigen::Vector3d::Zero());
  EXPECT_EQ(retraction_displacement(Eigen::Vector2d(0.5, 0.5), 2, {}), Eigen::Vector2d::Zero())
      << "no orientation";
}

// ---------------------------------------------------------------- the motion

/// From any motion under any wrench: begins where the platform is and as fast as it is, stays within its
/// limits, is smooth, and ends at rest where [SafePR] (23) says.
TEST(Retraction, LeadsSmoothlyFromTheMeasuredMotionToItsGoal) {
  RandomGenerator random(17);
  const RetractionSettings settings;
  const auto any = [&random](double bound) { return random.uniform(-bound, bound); };
  for (int trial = 0; trial < 200; ++trial) {
    Reflex reflex(settings);
    const Eigen::Vector3d pose(any(0.1), any(0.1), any(0.3)), velocity(any(1.0), any(1.0), any(3.0));
    const Eigen::Vector3d wrench(any(60.0), any(60.0), any(3.0));
    PlatformReference last = reflex.detect(moving(pose, velocity), pushed(wrench));
    ASSERT_TRUE(last.valid);
    ASSERT_LT((last.pose - PlatformVector(pose)).norm(), 1e-12);
    ASSERT_LT((last.velocity - PlatformVector(velocity)).norm(), 1e-12);
    while (!last.finished) {
      const PlatformReference now = reflex.tick();
      const PlatformVector mean = (now.pose - last.pose) / T;
      ASSERT_LT((mean - 0.5 * (now.velocity + last.velocity)).norm(), 2e-3);  // j T^2 / 12 and its corners
      ASSERT_LE((now.acceleration - last.acceleration).head(2).norm(), 2000.0 * T * 1.001);
      ASSERT_LE(now.acceleration.head(2).norm(), 20.0 * 1.001);
      ASSERT_LE(std::abs(now.acceleration[2]), 80.0 * 1.001);
      last = now;
    }
    const Eigen::Vector3d goal = pose + Eigen::Vector3d(retraction_displacement(wrench, 2, settings));
    ASSERT_LT((last.pose - PlatformVector(goal)).norm(), 1e-9) << trial;
    ASSERT_EQ(last.velocity, PlatformVector::Zero(3));
  }
}

TEST(Retraction, BrakesFirstWhenThePlatformMovesIntoTheContact) {
  Reflex reflex;
  const PlatformReference* now = &reflex.detect(moving({0, 0, 0}, {0.8, 0, 0}), pushed({-20.0, 0, 0}));
  double furthest = 0.0;
  while (!now->finished) {
    furthest = std::max(furthest, now->pose[0]);
    now = &reflex.tick();
  }
  // From 0.8 m/s, 10 ms of jerk 2000 m/s^3 down to 0.7 m/s and -20 m/s^2, which then turns the motion round.
  EXPECT_NEAR(furthest, 0.8 * 0.01 - 2000.0 * 1e-6 / 6.0 + 0.7 * 0.7 / (2.0 * 20.0), 1e-9);
  EXPECT_NEAR(now->pose[0], -0.1, 1e-12);
}

TEST(Retraction, HoldsItsEnd) {
  Reflex reflex;
  reflex.detect(moving({0.05, 0, 0.1}, {0, 0, 0}), pushed({0.0, 15.0, 0}));
  const PlatformVector end = reflex.finish().pose;
  reflex.state = {ReactionMode::hold, ReactionMode::react, reflex.ticking.now()};
  for (int k = 0; k < 100; ++k) {
    EXPECT_TRUE(reflex.tick().finished);
    EXPECT_EQ(reflex.tick().pose, end);
  }
  EXPECT_NEAR((end - PlatformVector(Eigen::Vector3d(0.05, 0.1, 0.1))).norm(), 0.0, 1e-12);
}

TEST(Retraction, KeepsItsDirectionWhateverTheForceDoesLater) {
  Reflex steady, changing;
  steady.detect(moving({0, 0, 0}, {0.3, 0.2, 0}), pushed({-12.0, 0, 0}));
  changing.detect(moving({0, 0, 0}, {0.3, 0.2, 0}), pushed({-12.0, 0, 0}));
  changing.ticking.set(changing.estimate, pushed({50.0, 50.0, 3.0}));
  for (int k = 0; k < 300; ++k) EXPECT_EQ(changing.tick().pose, steady.tick().pose);
}

TEST(Retraction, PlansAnewWhenTheNextReactionBegins) {
  Reflex reflex;
  reflex.detect(moving({0, 0, 0}, {0, 0, 0}), pushed({-12.0, 0, 0}));
  reflex.finish();
  reflex.state = {ReactionMode::nominal, ReactionMode::hold, reflex.ticking.now()};
  reflex.tick();
  EXPECT_FALSE(reflex.detect(moving({-0.05, 0, 0}, {0, 0, 0}), pushed({12.0, 0, 0})).finished);
  EXPECT_NEAR(reflex.finish().pose[0], 0.05, 1e-12);
}

// ---------------------------------------------------------------- bad input

TEST(Retraction, IsNotValidBeforeTheFirstReaction) { EXPECT_FALSE(Reflex().tick().valid); }

TEST(Retraction, IsNotValidWithoutAPose) {
  Reflex reflex;
  PlatformMotion lost = moving({0, 0, 0}, {0, 0, 0});
  lost.status = PlatformMotion::Status::no_data;
  EXPECT_FALSE(reflex.detect(lost, pushed({-12.0, 0, 0})).valid);
  EXPECT_FALSE(reflex.tick().valid);
  EXPECT_FALSE(Reflex().detect(moving({nan, 0, 0}, {0, 0, 0}), pushed({-12.0, 0, 0})).valid);
  EXPECT_FALSE(Reflex().detect(moving({0, 0, 0}, {0, nan, 0}), pushed({-12.0, 0, 0})).valid);
}

TEST(Retraction, BrakesWhereItIsWithoutAnEstimate) {
  const WrenchEstimate useless[] = {
      pushed({-12, 0, 0}, false),
      pushed({nan, 0, 0}),
      {.acquired = {}, .valid = true, .wrench_in_base = {}, .drive_torque = {}}};
  for (const WrenchEstimate& estimate : useless) {
    Reflex reflex;
    EXPECT_TRUE(reflex.detect(moving({0.02, 0, 0}, {0.5, 0, 0}), estimate).valid);
    EXPECT_NEAR(reflex.finish().pose[0], 0.02, 1e-12);
  }
}

TEST(Retraction, NeverAllocates) {
  Reflex reflex;
  reflex.tick();
  const test::AllocationCounter counter;
  reflex.detect(moving({0.02, 0, 0}, {0.5, 0.3, 1.0}), pushed({-12.0, 1, 0}));
  for (int k = 0; k < 10; ++k) reflex.tick();
  EXPECT_EQ(counter.count(), 0);
}

TEST(Retraction, RefusesSettingsThatAreNotPositive) {
  const auto robot = test::planar_rig();
  EXPECT_THROW(Retraction(robot, {.distance = 0.0}), SetupError);
  EXPECT_THROW(Retraction(robot, {.angle = -1.0}), SetupError);
  EXPECT_THROW(Retraction(robot, {.force_to_go_by = nan}), SetupError);
  RetractionSettings settings;
  settings.limits.rotation.jerk = 0.0;
  EXPECT_THROW(Retraction(robot, settings), SetupError);
}

}  // namespace
}  // namespace flinch
