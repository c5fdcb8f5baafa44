#include "systems/estimators/imu_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const ParallelRobot> hexapod() { return std::make_shared<Hexapod>(hexapod_robot()); }
std::shared_ptr<const ParallelRobot> planar() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
}

/// A motion known in closed form: sines along the axes, and one about an axis that stands still.
struct Motion {
  Configuration pose;
  PlatformVector velocity, acceleration;

  Motion(const ParallelRobot& robot, double t) {
    const ConfigurationSpace space = robot.space();
    PlatformVector way(space.dimension());
    velocity = acceleration = way;
    for (int i = 0; i < space.dimension(); ++i) {
      const bool turns = i >= space.translations();
      const double size = turns ? 0.1 : 0.05, rate = turns ? 8.0 : 9.0 + i;  // rotations in step: one axis
      way[i] = size * std::sin(rate * t);
      velocity[i] = size * rate * std::cos(rate * t);
      acceleration[i] = -rate * rate * way[i];
    }
    pose = space.plus(robot.home_pose(), way);
  }
};

const ImuBias bias{true, {0.02, -0.03, 0.05}, {0.3, -0.2, 0.39}};

class FilterRig {
 public:
  FilterRig(const std::shared_ptr<const ParallelRobot>& robot, const ImuFilterSettings& settings)
      : robot_(robot),
        block(builder_.add<ImuFilter>("filter", robot, settings)),
        platform_(builder_.export_input("platform", block.platform)),
        imu_(builder_.export_input("imu", block.imu)),
        ticking(builder_) {}

  ImuReading reading(Time acquired) {
    const Motion motion(*robot_, to_seconds(acquired));
    const auto value = imu_output(robot_->space(), ImuMount{}, robot_->gravity(), motion.pose,
                                  motion.velocity, motion.acceleration)
                           .value;
    ImuReading reading{acquired, true, value.head<3>() + bias.gyroscope,
                       value.tail<3>() + bias.accelerometer};
    for (int i = 0; i < 3; ++i) {
      reading.angular_velocity[i] += imu_noise * 2.74e-3 * random.normal();
      reading.specific_force[i] += imu_noise * 0.0395 * random.normal();
    }
    return reading;
  }
  /// One tick at which the IMU tells of `delay` ago.
  const PlatformAcceleration& see(Time delay = 0ms) {
    return see(ticking.now() < delay ? ImuReading() : reading(ticking.now() - delay));
  }
  const PlatformAcceleration& see(const ImuReading& reading) {
    const Motion motion(*robot_, to_seconds(ticking.now()));
    PlatformVector noise(robot_->dof());
    for (int i = 0; i < noise.size(); ++i) {
      noise[i] = pose_noise * (i < robot_->space().translations() ? 3.16e-5 : 1e-4) * random.normal();
    }
    ticking.set(platform_, {ticking.now(), PlatformMotion::Status::valid,
                            robot_->space().plus(motion.pose, noise), motion.velocity});
    ticking.set(imu_, reading);
    ticking.tick();
    return ticking.get(block.acceleration);
  }
  /// Largest error of the acceleration from 0.6 s to 1.2 s, of translations and of rotations.
  TwoKinds largest_error(Time delay) {
    TwoKinds largest{0.0, 0.0};
    for (int k = 0; k < 1200; ++k) {
      const PlatformAcceleration& seen = see(delay);
      if (k < 600) continue;
      EXPECT_TRUE(seen.valid) << k;
      const PlatformVector error =
          seen.acceleration - Motion(*robot_, to_seconds(seen.acquired)).acceleration;
      const int translations = robot_->space().translations();
      largest.translation = std::max(largest.translation, error.head(translations).lpNorm<Eigen::Infinity>());
      largest.rotation =
          std::max(largest.rotation, error.tail(robot_->space().rotations()).lpNorm<Eigen::Infinity>());
    }
    return largest;
  }

 private:
  std::shared_ptr<const ParallelRobot> robot_;
  DiagramBuilder builder_;

 public:
  ImuFilter& block;
  double imu_noise = 0.0, pose_noise = 0.0;
  RandomGenerator random{9};

 private:
  InputPort<PlatformMotion> platform_;
  InputPort<ImuReading> imu_;

 public:
  test::Ticking ticking;
};

TEST(ImuFilter, TellsTheAccelerationOfAnyMechanismInSpiteOfBiasAndDelay) {
  for (const auto& robot : {hexapod(), planar()}) {
    for (const Time delay : {0ms, 4ms}) {
      FilterRig rig(robot, extended_imu_filter());
      const TwoKinds largest = rig.largest_error(delay);
      EXPECT_LT(largest.translation, 0.05);  // of 7 m/s^2
      EXPECT_LT(largest.rotation, 0.3);      // of 6.4 rad/s^2
      const ImuBias& found = rig.ticking.get(rig.block.bias);
      ASSERT_TRUE(found.valid);
      EXPECT_LT((found.gyroscope - bias.gyroscope).norm(), 2e-3);
      EXPECT_LT((found.accelerometer - bias.accelerometer).norm(), 0.02);
    }
  }
}

TEST(UnscentedImuFilter, TellsTheAccelerationOfAnyMechanismInSpiteOfBiasAndDelay) {
  for (const auto& robot : {hexapod(), planar()}) {
    FilterRig rig(robot, unscented_imu_filter());
    const TwoKinds largest = rig.largest_error(4ms);
    EXPECT_LT(largest.translation, 0.05);
    EXPECT_LT(largest.rotation, 0.3);
  }
}

/// Largest difference of both accelerations, by their standard deviation, of one that is told of an uncertain
/// orientation.
double difference_by_points(const std::shared_ptr<const ParallelRobot>& robot, double orientation_deviation) {
  ImuFilterSettings extended = extended_imu_filter(), unscented = unscented_imu_filter();
  for (ImuFilterSettings* const each : {&extended, &unscented}) {
    each->initial_pose.rotation = orientation_deviation * orientation_deviation;
    each->noise.encoder_pose.rotation = each->initial_pose.rotation;
  }
  FilterRig one(robot, extended), other(robot, unscented);
  double largest = 0.0;
  for (int k = 0; k < 300; ++k) {
    const PlatformAcceleration a = one.see(), b = other.see();
    if (k < 20) continue;  // nothing is known of the velocity
    largest = std::max(
        largest,
        (b.acceleration - a.acceleration).cwiseQuotient(a.standard_deviation).lpNorm<Eigen::Infinity>());
  }
  return largest;
}

// Both are the same filter where the output hardly bends within the errors of the states.
TEST(UnscentedImuFilter, IsTheExtendedOneWhereThatIsSureOfItsOrientation) {
  for (const auto& robot : {hexapod(), planar()}) {
    const double sure = difference_by_points(robot, 1e-4), unsure = difference_by_points(robot, 0.3);
    std::printf(
        "  %d coordinates: differ by %.4f deviations, by %.2f where the orientation is unsure by 0.3 rad\n",
        robot->dof(), sure, unsure);
    EXPECT_LT(sure, 0.02);
    EXPECT_GT(unsure, 5.0 * sure);
  }
}

TEST(UnscentedImuFilter, DoesNotAllocate) {
  for (const auto& robot : {hexapod(), planar()}) {
    FilterRig rig(robot, unscented_imu_filter());
    for (int k = 0; k < 20; ++k) rig.see();
    const test::AllocationCounter allocations;
    for (int k = 0; k < 20; ++k) rig.see();
    EXPECT_EQ(allocations.count(), 0);
  }
}

TEST(ImuFilter, FollowsTheIndicationOfItsTimeBetweenTwoPoses) {
  FilterRig rig(planar(), extended_imu_filter());
  EXPECT_LT(rig.largest_error(3500us).translation, 0.05);
}

TEST(ImuFilter, ErrsByBiasAndDelayAsPrinted) {
  FilterRig rig(planar(), published_imu_filter());
  EXPECT_GT(rig.largest_error(4ms).translation, 0.3);
}

/// Mean of what the monitor tells where the sensors have so many times the noise that the filter was told of.
double mean_innovation(double noise) {
  FilterRig rig(planar(), extended_imu_filter());
  rig.imu_noise = rig.pose_noise = noise;
  double mean = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const PlatformAcceleration& seen = rig.see();
    if (k >= 1000) mean += seen.health.innovation / 5000.0;
  }
  return mean;
}

// Below 1, for the motion is smoother than the filter expects.
TEST(ImuFilter, HasInnovationsNoLargerThanItExpectsUnlessTheNoiseIs) {
  EXPECT_GT(mean_innovation(1.0), 0.6);
  EXPECT_LT(mean_innovation(1.0), 1.05);
  EXPECT_NEAR(mean_innovation(4.0) / mean_innovation(1.0), 16.0, 1.0);
}

TEST(ImuFilter, SeesAllItsStatesWhereItHasThePose) {
  FilterRig published(planar(), published_imu_filter()), extended(planar(), extended_imu_filter());
  for (int k = 0; k < 300; ++k) published.see(), extended.see();
  EXPECT_GT(published.ticking.get(published.block.observability), 1e-3);
  EXPECT_GT(extended.ticking.get(extended.block.observability), 1e-8);
  EXPECT_LT(extended.ticking.get(extended.block.observability),
            published.ticking.get(published.block.observability));  // biases are hard to tell in 2 ms
}

TEST(ImuFilter, DoesNotBelieveAnImuThatContradictsTheEncoders) {
  FilterRig rig(planar(), extended_imu_filter());
  for (int k = 0; k < 600; ++k) rig.see();
  ASSERT_TRUE(rig.ticking.get(rig.block.acceleration).valid);
  int believed = 0;
  for (int k = 0; k < 100; ++k) {
    ImuReading wrong = rig.reading(rig.ticking.now());
    wrong.specific_force = -wrong.specific_force;
    if (rig.see(wrong).valid) ++believed;
  }
  EXPECT_LT(believed, 20);
  EXPECT_FALSE(rig.ticking.get(rig.block.acceleration).valid);
}

TEST(ImuFilter, IsNotValidInATickWithoutTheImuAndGoesOnAfterwards) {
  FilterRig rig(planar(), extended_imu_filter());
  for (int k = 0; k < 600; ++k) rig.see();
  for (int k = 0; k < 2; ++k) EXPECT_FALSE(rig.see(ImuReading()).valid);
  EXPECT_TRUE(rig.see().valid);
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(rig.see(ImuReading()).valid);
  for (int k = 0; k < 400; ++k) {  // it begins anew
    const bool valid = rig.see().valid;
    ASSERT_EQ(valid, k >= 200) << k;
  }
}

TEST(ImuFilter, KeepsNothingThatIsNotANumber) {
  FilterRig rig(planar(), extended_imu_filter());
  for (int k = 0; k < 600; ++k) rig.see();
  ImuReading wrong = rig.reading(rig.ticking.now());
  wrong.angular_velocity.x() = nan;
  EXPECT_FALSE(rig.see(wrong).valid);
  wrong.angular_velocity.x() = 1e300;
  EXPECT_FALSE(rig.see(wrong).valid);
  const PlatformAcceleration& seen = rig.see();
  EXPECT_TRUE(seen.valid && seen.acceleration.allFinite() && seen.standard_deviation.allFinite());
}

TEST(ImuFilter, AsksForNoiseThatIsPositive) {
  ImuFilterSettings settings = extended_imu_filter();
  settings.noise.gyroscope = 0.0;
  settings.noise.encoder_pose.rotation = nan;
  try {
    const ImuFilter filter(planar(), settings);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

}  // namespace
}  // namespace flinch
