#include "systems/estimators/direct_method.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "systems/framework/random.h"
#include "tests/support/planar_rig.h"
#include "tests/support/smooth_trajectory.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

/// What the method sees of a motion under a wrench.
struct Instant {
  test::Posture at;
  DriveTorque torque;
  PlatformAcceleration acceleration;
  PlatformVector driving;  ///< F_a
};

const PlatformVector F_ext{{80.0, -15.0, 2.0}};

/// On the smooth trajectory, pushed by F_ext.
Instant instant(const PlanarRrr& robot, Time now) {
  const test::SmoothTrajectory motion(to_seconds(now));
  Instant seen{test::Posture(robot, motion.pose, motion.velocity, now), {}, {}, {}};
  const Dynamics& model = seen.at.dynamics;
  const PlatformVector F_a = model.M_x * PlatformVector(motion.acceleration) +
                             model.C_x * PlatformVector(motion.velocity) + model.g_x + model.F_fr_x - F_ext;
  seen.driving = F_a;
  seen.torque = {now, true, drive_torques(seen.at.kinematics, F_a)};
  seen.acceleration.acquired = now;
  seen.acceleration.valid = true;
  seen.acceleration.acceleration = motion.acceleration;
  return seen;
}

class DirectMethodTest : public testing::Test {
 protected:
  const WrenchEstimate& see(const Instant& now, const PlatformAcceleration& acceleration) {
    ticking_.set(platform_, now.at.platform);
    ticking_.set(kinematics_, now.at.kinematics);
    ticking_.set(dynamics_, now.at.dynamics);
    ticking_.set(torque_, now.torque);
    ticking_.set(acceleration_, acceleration);
    ticking_.tick();
    return ticking_.get(block_.wrench);
  }

  std::shared_ptr<const PlanarRrr> robot_ = test::planar_rig(RigFriction::simulation);
  DiagramBuilder builder_;
  DirectMethod& block_ = builder_.add<DirectMethod>("block", robot_);
  InputPort<PlatformMotion> platform_ = builder_.export_input("platform", block_.platform);
  InputPort<Kinematics> kinematics_ = builder_.export_input("kinematics", block_.kinematics);
  InputPort<Dynamics> dynamics_ = builder_.export_input("dynamics", block_.dynamics);
  InputPort<DriveTorque> torque_ = builder_.export_input("torque", block_.torque);
  InputPort<PlatformAcceleration> acceleration_ = builder_.export_input("acceleration", block_.acceleration);
  test::Ticking ticking_{builder_};
};

TEST_F(DirectMethodTest, IsExactForAnExactAcceleration) {
  for (int k = 0; k < 500; ++k) {
    const Instant now = instant(*robot_, ticking_.now());
    const WrenchEstimate& estimate = see(now, now.acceleration);
    ASSERT_TRUE(estimate.valid);
    ASSERT_LT((estimate.wrench_in_base - F_ext).norm(), 1e-11) << k;
    ASSERT_LT((estimate.drive_torque - now.at.kinematics.J_x_qa.transpose() * F_ext).norm(), 1e-11);
  }
}

TEST_F(DirectMethodTest, SetsALateAccelerationAgainstModelAndTorquesOfThen) {
  std::vector<PlatformAcceleration> underway;
  for (int k = 0; k < 500; ++k) {
    const Instant now = instant(*robot_, ticking_.now());
    underway.push_back(now.acceleration);
    const WrenchEstimate& estimate = see(now, k < 4 ? PlatformAcceleration() : underway[underway.size() - 5]);
    ASSERT_EQ(estimate.valid, k >= 4);
    if (k < 4) continue;
    ASSERT_EQ(estimate.acquired, (k - 4) * 1ms);
    ASSERT_LT((estimate.wrench_in_base - F_ext).norm(), 1e-11) << k;
  }
}

// What is not even between two ticks: an eighth of its second derivative times T^2.
TEST_F(DirectMethodTest, SetsAnAccelerationBetweenTwoTicksAgainstWhatIsBetweenThem) {
  for (int k = 0; k < 500; ++k) {
    const Time then = ticking_.now() - 4300us;
    const Instant between = instant(*robot_, then), after = instant(*robot_, then + 300us);
    PlatformAcceleration late = between.acceleration;  // and what the torque makes that was held
    late.acceleration += between.at.dynamics.M_x.llt().solve(after.driving - between.driving);
    const WrenchEstimate& estimate = see(instant(*robot_, ticking_.now()), late);
    if (k < 5) continue;
    ASSERT_TRUE(estimate.valid) << k;
    ASSERT_EQ(estimate.acquired, then);
    ASSERT_LT((estimate.wrench_in_base - F_ext).norm(), 0.01) << k;
  }
}

// The components of the acceleration are taken to err by themselves: drawn like that, so does the wrench.
TEST_F(DirectMethodTest, TellsTheDeviationThatNoiseOfTheAccelerationCauses) {
  RandomGenerator random(6);
  const PlatformVector deviation{{0.5, 0.2, 3.0}};
  PlatformVector squares = PlatformVector::Zero(3), told;
  const Instant still = instant(*robot_, 0ms);
  for (int k = 0; k < 20'000; ++k) {
    PlatformAcceleration noisy = still.acceleration;
    for (int i = 0; i < 3; ++i) noisy.acceleration[i] += deviation[i] * random.normal();
    noisy.standard_deviation = deviation;
    const WrenchEstimate& estimate = see(still, noisy);
    squares += (estimate.wrench_in_base - F_ext).cwiseAbs2() / 20'000;
    told = estimate.standard_deviation;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(squares[i]) / told[i], 1.0, 0.03);
}

TEST_F(DirectMethodTest, KnowsNothingUnderClosedBrakes) {
  Instant now = instant(*robot_, ticking_.now());
  now.torque.braked = true;
  const WrenchEstimate& estimate = see(now, now.acceleration);
  EXPECT_TRUE(estimate.valid);
  EXPECT_EQ(estimate.wrench_in_base, PlatformVector::Zero(3));
}

TEST_F(DirectMethodTest, IsNotValidUnlessAllThatItReadsIs) {
  const Instant good = instant(*robot_, 0ms);
  Instant bad = good;
  bad.torque.valid = false;
  EXPECT_FALSE(see(bad, good.acceleration).valid);
  bad = good;
  bad.torque.torque[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(see(bad, good.acceleration).valid);
  bad = good;
  bad.at.platform.status = PlatformMotion::Status::singular;
  EXPECT_FALSE(see(bad, good.acceleration).valid);
  EXPECT_FALSE(see(good, PlatformAcceleration()).valid);
  bad.acceleration.acceleration.resize(2);
  EXPECT_FALSE(see(good, bad.acceleration).valid);
  EXPECT_TRUE(see(good, good.acceleration).valid);
}

}  // namespace
}  // namespace flinch
