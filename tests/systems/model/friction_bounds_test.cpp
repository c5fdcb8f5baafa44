#include "systems/model/friction_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

/// A 3-RRR whose drives have dry friction, followed a millisecond a time.
class Drives {
 public:
  Drives() : robot_(test::planar_rig(RigFriction::test_rig)), bounds_(*robot_, FrictionBoundsSettings()) {}

  FrictionInterval at(const JointVector& rate) {
    FrictionBoundsMemory next;
    bounds_.follow(now_, rate, memory_, next);
    now_ += 1ms;
    memory_ = next;
    return bounds_.interval(rate, memory_);
  }
  void wait(Time time) { now_ += time; }
  DryFriction friction(int drive) const { return robot_->dry_friction(drive); }

 private:
  std::shared_ptr<const PlanarRrr> robot_;
  FrictionBounds bounds_;
  FrictionBoundsMemory memory_;
  Time now_{};
};

const double share = FrictionBoundsSettings().share;

JointVector rates(double first) { return Eigen::Vector3d(first, 0.0, 0.0); }

TEST(FrictionBounds, AreAsWideAsDryFrictionAtRestAndNoneInMotion) {
  Drives drives;
  FrictionInterval bounds = drives.at(rates(0.0));
  EXPECT_NEAR(bounds.high[0], share * drives.friction(0).effort, 1e-12);
  EXPECT_NEAR(bounds.low[0], -share * drives.friction(0).effort, 1e-12);
  for (int k = 0; k < 100; ++k) bounds = drives.at(rates(0.5));
  EXPECT_EQ(bounds.high[0], 0.0);
  EXPECT_EQ(bounds.low[0], 0.0);
  EXPECT_NEAR(bounds.high[1], share * drives.friction(1).effort, 1e-12) << "each drive for itself";
}

/// True friction is what it wants within its largest, +-15 %, and the law says f: what an estimator sees of
/// that is f less the truth.
TEST(FrictionBounds, HoldWhateverDryFrictionDoesBelowTheRateAtWhichItMayStick) {
  Drives drives;
  for (double rate = -0.014; rate < 0.015; rate += 0.0005) {
    const FrictionInterval bounds = drives.at(rates(rate));
    for (const double truth : {-1.15, -1.0, 0.0, 0.3, 1.0, 1.15}) {
      const double seen = drives.friction(0).at(rate) - truth * drives.friction(0).effort;
      EXPECT_GE(seen, bounds.low[0]) << rate;
      EXPECT_LE(seen, bounds.high[0]) << rate;
    }
  }
}

TEST(FrictionBounds, OpenAgainWhereADriveTurnsRoundUntilItHasGoneSomeWay) {
  Drives drives;
  for (int k = 0; k < 200; ++k) drives.at(rates(1.0));
  double gone = 0.0;
  for (int k = 0; k < 12; ++k) {
    const FrictionInterval bounds = drives.at(rates(-1.0));  // as by a blow, without a tick at rest
    gone += 1e-3;
    EXPECT_EQ(bounds.high[0] > bounds.low[0] + 1.9 * share * drives.friction(0).effort, gone < 4e-3) << k;
  }
}

TEST(FrictionBounds, CloseInMillisecondsOnceADriveIsFast) {
  Drives drives;
  for (int k = 0; k < 50; ++k) drives.at(rates(0.01));  // gone less than the presliding, but for its rate
  for (int k = 0; k < 200; ++k) drives.at(rates(0.02));
  double before = drives.at(rates(0.2)).high[0];
  for (int k = 0; k < 8; ++k) {
    const double after = drives.at(rates(0.2)).high[0];
    EXPECT_NEAR(after / before, std::exp(-1.0 / 4.0), 1e-12) << k;
    before = after;
  }
}

TEST(FrictionBounds, AreAsOfRestAfterAGap) {
  Drives drives;
  for (int k = 0; k < 200; ++k) drives.at(rates(1.0));
  drives.wait(1s);
  EXPECT_GT(drives.at(rates(1.0)).high[0], drives.friction(0).effort);
}

TEST(FrictionBounds, AreNoneWhereTheModelHasNoDryFriction) {
  const auto robot = test::planar_rig();
  FrictionBounds bounds(*robot, {});
  FrictionBoundsMemory next;
  bounds.follow(1ms, rates(0.0), {}, next);
  EXPECT_EQ(bounds.interval(rates(0.0), next).high, JointVector::Zero(3));
}

}  // namespace
}  // namespace flinch
