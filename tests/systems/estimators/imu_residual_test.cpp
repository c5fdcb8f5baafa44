#include "systems/estimators/imu_residual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/forward_dynamics.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

const Eigen::Vector3d bias(0.3, -0.2, 0.39), rate_bias(0.02, -0.03, 0.05);
const PlatformVector zero = PlatformVector::Zero(3);

/// The robot, held in one place by the test as far as the encoders tell, while the IMU tells of any motion.
class ImuResidualTest : public testing::Test {
 protected:
  /// One tick at which the drives have this torque and the platform is pushed; the IMU is `delay` ticks late.
  const WrenchEstimate& see(const JointVector& torque, const PlatformVector& push, std::size_t delay = 0) {
    const Time now = ticking_.now();
    test::Posture at(*robot_, zero, zero, now);
    if (moves_) at.platform.velocity[0] = 0.02;  // no rest to learn a bias from
    JointVector acted = torque;
    if (before_tick_ > Time::zero())  // half at once, all in 0.6 ms, then held
      acted = torque_before_ +
              std::min(1.0, 0.5 + (1e-3 - to_seconds(before_tick_)) / 1.2e-3) * (torque - torque_before_);
    const PlatformVector acceleration = *forward_dynamics(at.kinematics, at.dynamics, acted, push);
    const double angular = (*forward_dynamics(at.kinematics, at.dynamics, torque, push))[2];
    const double angular_before = (*forward_dynamics(at.kinematics, at.dynamics, torque_before_, push))[2];
    const auto turned_in = [&](double time) {  // since the tick before, of a sample between two ticks
      const double reached = time < 6e-4 ? time / 2.0 + time * time / 2.4e-3 : time - 1.5e-4;
      return time * angular_before + reached * (angular - angular_before);
    };
    const bool between = before_tick_ > Time::zero();
    const double turned = turned_ + (between ? turned_in(1e-3 - to_seconds(before_tick_)) : 1e-3 * angular);
    turned_ += between ? turned_in(1e-3) : 1e-3 * angular;
    torque_before_ = torque;
    const ImuOutput output =
        imu_output(robot_->space(), ImuMount{}, robot_->gravity(), zero, zero, acceleration);
    const Eigen::Vector3d rate = output.by_velocity.col(2).head<3>() * turned;
    underway_.push_back({now - before_tick_, true, rate + rate_bias, output.value.tail<3>() + bias});
    for (int i = 0; i < 3; ++i) {
      underway_.back().angular_velocity[i] += noise_ * 2.74e-3 * random_.normal();
      underway_.back().specific_force[i] += noise_ * 0.0395 * random_.normal();
    }
    underway_.back().specific_force[2] += upwards_;
    ticking_.set(platform_, at.platform);
    ticking_.set(kinematics_, at.kinematics);
    ticking_.set(dynamics_, at.dynamics);
    ticking_.set(torque_, {now, true, torque});
    ticking_.set(imu_, underway_.size() > delay ? underway_[underway_.size() - 1 - delay] : ImuReading());
    ticking_.tick();
    return ticking_.get(block_.wrench);
  }
  void rest(const PlatformVector& push = zero) {
    const test::Posture at(*robot_, zero, zero);
    const JointVector against = drive_torques(at.kinematics, -push);
    for (int k = 0; k < 150; ++k) {
      const bool valid = see(against, push).valid;
      ASSERT_EQ(valid, k >= 49 + 3 * 25) << k << ": two times 25 samples at rest, and 25 more";
    }
    moves_ = true;
  }

  std::shared_ptr<const PlanarRrr> robot_ = test::planar_rig();
  DiagramBuilder builder_;
  ImuResidual& block_ = builder_.add<ImuResidual>("block", robot_, ImuResidualSettings{});
  InputPort<PlatformMotion> platform_ = builder_.export_input("platform", block_.platform);
  InputPort<Kinematics> kinematics_ = builder_.export_input("kinematics", block_.kinematics);
  InputPort<Dynamics> dynamics_ = builder_.export_input("dynamics", block_.dynamics);
  InputPort<DriveTorque> torque_ = builder_.export_input("torque", block_.torque);
  InputPort<ImuReading> imu_ = builder_.export_input("imu", block_.imu);
  test::Ticking ticking_{builder_};
  std::deque<ImuReading> underway_;
  bool moves_ = false;
  Time before_tick_{};  ///< that the IMU measures
  JointVector torque_before_ = JointVector::Zero(3);
  double turned_ = 0.0, noise_ = 0.0, upwards_ = 0.0;
  RandomGenerator random_{2};
};

const PlatformVector push{{25.0, -40.0, 3.0}};

TEST_F(ImuResidualTest, LearnsNoBiasWhereThePlatformOnlyTurnsBack) {
  rest();
  for (int k = 0; k < 2000; ++k) {  // slow for 9 of 100 ticks, while it accelerates
    moves_ = k % 100 < 91;
    see(drive_torques(test::Posture(*robot_, zero, zero).kinematics, PlatformVector{{10.0, 0.0, 0.0}}), zero);
  }
  // The model knows of that acceleration, so that what is left is what the bias is wrong by.
  EXPECT_LT(see(JointVector::Zero(3), zero).wrench_in_base.norm(), 1e-6);
}

TEST_F(ImuResidualTest, LearnsNoBiasFromAStart) {
  for (const int rested : {150, 160, 170}) {
    moves_ = false;
    for (int k = 0; k < rested; ++k)
      see(drive_torques(test::Posture(*robot_, zero, zero).kinematics, zero), zero);
    for (int k = 0; k < 9; ++k)  // slow still, but it accelerates
      see(drive_torques(test::Posture(*robot_, zero, zero).kinematics, PlatformVector{{10.0, 0.0, 0.0}}),
          zero);
    moves_ = true;
    EXPECT_LT(see(JointVector::Zero(3), zero).wrench_in_base.norm(), 1e-6) << rested;
  }
}

// Pushed so that nothing turns, the accelerometer says it all; so that nothing but turns, the gyroscope,
// whose observer answers by 1 - exp(-gain t).
TEST_F(ImuResidualTest, SeesWhatShiftsThePlatformAtOnceAndWhatTurnsItByItsGain) {
  const PlatformMatrix M_x = test::Posture(*robot_, zero, zero).dynamics.M_x;
  const PlatformVector shift = M_x * PlatformVector{{6.0, -4.0, 0.0}},
                       turn = M_x * PlatformVector{{0.0, 0.0, 30.0}};
  rest();
  EXPECT_LT((see(JointVector::Zero(3), shift).wrench_in_base - shift).norm(), 1e-9 * shift.norm());
  see(JointVector::Zero(3), zero);
  for (int k = 0; k < 40; ++k) {
    const double answer = 1.0 - std::exp(-0.3 * (k + 1));
    const WrenchEstimate& seen = see(JointVector::Zero(3), turn);
    // Off the middle of the platform the accelerometer feels the turn as well, and takes it for a shift at
    // first.
    ASSERT_LT((seen.wrench_in_base - answer * turn).norm(), 0.01 + 0.6 * (1.0 - answer)) << k;
  }
}

// Rested against while it learned the bias, and held by its drives: that is a wrench, no bias.
TEST_F(ImuResidualTest, LearnsTheBiasWhetherItIsTouchedOrNot) {
  rest(push);
  const test::Posture at(*robot_, zero, zero);
  EXPECT_LT((see(drive_torques(at.kinematics, -push), push).wrench_in_base - push).norm(), 0.3);
}

TEST_F(ImuResidualTest, ComparesWithTheTorquesOfTheTimeAtWhichTheImuMeasured) {
  rest();
  RandomGenerator random(5);
  for (int k = 0; k < 200; ++k) {  // torques that jump in every tick, and nothing that pushes
    const JointVector torque = JointVector::NullaryExpr(3, [&] { return random.uniform(-3.0, 3.0); });
    const WrenchEstimate& seen = see(torque, zero, 4);
    if (k <= 4) continue;
    ASSERT_LT(seen.wrench_in_base.norm(), 2.0) << k;
  }
}

// Torques that rise and fall, and nothing that pushes: nothing is left, whatever the phase.
TEST_F(ImuResidualTest, ComparesASampleBetweenTwoTicksWithWhatIsBetweenThem) {
  rest();
  for (const Time before_tick : {0us, 60us, 300us, 500us, 900us}) {
    before_tick_ = before_tick;
    double largest = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double height = std::abs(k % 200 - 100) * 0.08;
      const WrenchEstimate& seen = see(JointVector::Constant(3, height), zero, 4);
      if (k <= 100) continue;
      ASSERT_TRUE(seen.valid);
      largest = std::max(largest, seen.wrench_in_base.norm());
    }
    EXPECT_LT(largest, 1e-3) << to_seconds(before_tick) << " s";
  }
}

// Between two samples a gyroscope shows the mean of dw/dt, in which torques of two ticks have a part.
TEST_F(ImuResidualTest, ComparesTheGyroscopeWithAllThatHappenedBetweenTwoSamples) {
  rest();
  RandomGenerator random(5);
  for (const Time before_tick : {60us, 300us, 500us, 900us}) {
    before_tick_ = before_tick;
    double largest = 0.0;
    for (int k = 0; k < 400; ++k) {
      const JointVector torque = JointVector::NullaryExpr(3, [&] { return random.uniform(-3.0, 3.0); });
      const WrenchEstimate& seen = see(torque, zero, 4);
      if (k <= 100) continue;
      ASSERT_TRUE(seen.valid);
      largest = std::max(largest, seen.wrench_in_base.norm());
    }
    EXPECT_LT(largest, 1e-6) << to_seconds(before_tick) << " s";
  }
}

TEST_F(ImuResidualTest, TellsTheDeviationThatNoiseOfTheImuCauses) {
  rest();
  noise_ = 1.0;
  PlatformVector squares = zero, told;
  for (int k = 0; k < 20'000; ++k) {
    const WrenchEstimate& seen = see(JointVector::Zero(3), zero);
    squares += seen.wrench_in_base.cwiseAbs2() / 20'000;
    told = seen.standard_deviation;
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(squares[i]) / told[i], 1.0, 0.1) << i;
}

// Of the six axes three are left that no acceleration in the plane explains.
TEST_F(ImuResidualTest, MonitorsWhatNoMotionInThePlaneExplains) {
  rest();
  noise_ = 1.0;
  double mean = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const WrenchEstimate& seen = see(JointVector::Zero(3), zero);
    ASSERT_TRUE(seen.valid) << k;
    mean += seen.health.innovation / 5000;
  }
  EXPECT_NEAR(mean, 1.0, 0.1);
  EXPECT_TRUE(see(JointVector::Zero(3), push).valid) << "a push in the plane is explained";
  upwards_ = 1.0;
  int k = 0;
  while (k < 100 && see(JointVector::Zero(3), zero).valid) ++k;
  EXPECT_LT(k, 5) << "1 m/s^2 out of the plane, 25 deviations";
}

TEST_F(ImuResidualTest, IsLessSureWhereTheExpectationIsSteep) {
  rest();
  const double calm = see(JointVector::Zero(3), zero).standard_deviation[0];
  const double steep = see(JointVector{{5.0, 0.0, 0.0}}, zero).standard_deviation[0];
  EXPECT_GT(steep, 5.0 * calm);
}

TEST_F(ImuResidualTest, AsksForSettingsThatArePositive) {
  ImuResidualSettings settings;
  settings.accelerometer_deviation = 0.0;
  settings.rest_samples = 0;
  settings.jitter = -1ms;
  try {
    const ImuResidual residual(robot_, settings);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
  }
}

}  // namespace
}  // namespace flinch
