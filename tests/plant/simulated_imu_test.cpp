#include "plant/simulated_imu.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "systems/foundation/setup_error.h"
#include "tests/plant/rig_scene.h"
#include "tests/plant/sensor_rig.h"

namespace flinch {
namespace {

const Eigen::Vector3d gravity(0.0, 0.0, -9.81);

/// An IMU on a platform whose motion the test sets.
class Imu {
 public:
  explicit Imu(const SimulatedImuSettings& settings, std::uint64_t seed = 1)
      : ticking_(wire(settings, seed)) {}

  ImuReading read(PlantTruth truth = test::truth_at_rest()) {
    truth.acquired = ticking_.now();
    ticking_.set(truth_, truth);
    ticking_.tick();
    return ticking_.get(imu_);
  }

  const SimulatedImu& block() const { return *block_; }
  Time now() const { return ticking_.now(); }

 private:
  DiagramBuilder& wire(const SimulatedImuSettings& settings, std::uint64_t seed) {
    auto& imu = builder_.add<SimulatedImu>("imu", settings, *test::individual_rig(), seed);
    block_ = &imu;
    truth_ = builder_.export_input("truth", imu.truth);
    imu_ = imu.imu;
    return builder_;
  }

  DiagramBuilder builder_{"test", 1ms};
  const SimulatedImu* block_ = nullptr;
  InputPort<PlantTruth> truth_;
  OutputPort<ImuReading> imu_;
  test::Ticking ticking_;
};

SimulatedImuSettings without_errors() {
  SimulatedImuSettings settings;
  settings.ideal = true;
  return settings;
}

/// A smooth motion of the platform, and where it takes a point of the sensor's frame.
Eigen::Vector3d pose_at(double t) {
  return {0.2 * std::sin(5.0 * t), 0.15 * std::cos(7.0 * t), 0.4 * std::sin(6.0 * t)};
}

PlantTruth moving_truth(double t) {
  PlantTruth truth = test::truth_at_rest();
  truth.pose = pose_at(t);
  truth.velocity =
      Eigen::Vector3d(1.0 * std::cos(5.0 * t), -1.05 * std::sin(7.0 * t), 2.4 * std::cos(6.0 * t));
  truth.acceleration =
      Eigen::Vector3d(-5.0 * std::sin(5.0 * t), -7.35 * std::cos(7.0 * t), -14.4 * std::sin(6.0 * t));
  return truth;
}

Eigen::Isometry3d platform_at(double t) {
  const Eigen::Vector3d pose = pose_at(t);
  return Eigen::Translation3d(pose.x(), pose.y(), 0.0) *
         Eigen::AngleAxisd(pose.z(), Eigen::Vector3d::UnitZ());
}

TEST(SimulatedImu, AtRestReadsPlusGravityUpwards) {
  SimulatedImuSettings settings = without_errors();
  settings.angles.setZero();
  const ImuReading reading = Imu(settings).read();
  EXPECT_TRUE(reading.valid);
  EXPECT_TRUE(reading.specific_force.isApprox(Eigen::Vector3d(0.0, 0.0, 9.81), 1e-14));
  EXPECT_EQ(reading.angular_velocity, Eigen::Vector3d::Zero());
  EXPECT_NEAR(Imu(without_errors()).read().specific_force.norm(), 9.81, 1e-13) << "however it is mounted";
}

TEST(SimulatedImu, ReadsTheTwiceDifferentiatedPositionOfItsOrigin) {
  SimulatedImuSettings settings = without_errors();
  settings.position_in_platform << 0.075, 0.054, -0.097;
  constexpr double h = 1e-4;
  Imu imu(settings);
  const Eigen::Matrix3d R_ES = (Eigen::AngleAxisd(settings.angles.x(), Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(settings.angles.y(), Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(settings.angles.z(), Eigen::Vector3d::UnitZ()))
                                   .toRotationMatrix();
  for (double t = 0.0; t < 1.0; t += 0.05) {
    const ImuReading reading = imu.read(moving_truth(t));
    const auto origin = [&](double time) -> Eigen::Vector3d {
      return platform_at(time) * settings.position_in_platform;
    };
    const Eigen::Vector3d acceleration = (-origin(t + 2 * h) + 16.0 * origin(t + h) - 30.0 * origin(t) +
                                          16.0 * origin(t - h) - origin(t - 2 * h)) /
                                         (12.0 * h * h);
    const Eigen::Matrix3d R_0S = platform_at(t).linear() * R_ES;
    EXPECT_NEAR((reading.specific_force - R_0S.transpose() * (acceleration - gravity)).norm(), 0.0, 1e-6);

    const Eigen::AngleAxisd turned(platform_at(t - h).linear().transpose() * platform_at(t + h).linear());
    const Eigen::Vector3d omega_in_platform = turned.angle() / (2.0 * h) * turned.axis();
    EXPECT_NEAR((reading.angular_velocity - R_ES.transpose() * omega_in_platform).norm(), 0.0, 1e-5);
  }
}

TEST(SimulatedImu, DeliversEachSampleAtTheFirstTickAfterItsDelay) {
  SimulatedImuSettings settings;
  settings.accelerometer_density = settings.gyroscope_density = 0.0;
  settings.accelerometer_bias = settings.gyroscope_bias = 0.0;
  settings.accelerometer_resolution = settings.gyroscope_resolution = 0.0;
  Imu late(settings);
  SimulatedImuSettings at_once = settings;
  at_once.delay = Time::zero();
  Imu prompt(at_once);
  std::vector<ImuReading> measured;
  for (int k = 0; k < 50; ++k) {
    measured.push_back(prompt.read(moving_truth(1e-3 * k)));
    const ImuReading arrived = late.read(moving_truth(1e-3 * k));
    if (k < 4) {
      EXPECT_FALSE(arrived.valid) << k;
      continue;
    }
    const ImuReading& expected =
        measured[static_cast<std::size_t>(k - 4)];  // 3.5 ms, and up to the next tick
    EXPECT_TRUE(arrived.valid);
    EXPECT_EQ(arrived.acquired, 1ms * (k - 4));
    EXPECT_EQ(arrived.specific_force, expected.specific_force);
    EXPECT_EQ(arrived.angular_velocity, expected.angular_velocity);
  }
}

TEST(SimulatedImu, MeasuresSoLongBeforeTheTickAsItIsTold) {
  SimulatedImuSettings settings;
  settings.accelerometer_density = settings.gyroscope_density = 0.0;
  settings.accelerometer_bias = settings.gyroscope_bias = 0.0;
  settings.accelerometer_resolution = settings.gyroscope_resolution = 0.0;
  settings.delay = Time::zero();
  SimulatedImuSettings before = settings;
  before.clock.before_tick = 300us;
  for (int k = 1; k < 50; ++k) {
    const double t = 1e-3 * k;
    const ImuReading early = Imu(before).read(moving_truth(t));
    const ImuReading then = Imu(settings).read(moving_truth(t - 300e-6));
    EXPECT_EQ(early.acquired, -300us) << "of the first tick";
    EXPECT_LT((early.angular_velocity - then.angular_velocity).norm(), 1e-5);
    EXPECT_LT((early.specific_force - then.specific_force).norm(), 0.05) << "with the acceleration of now";
  }
  settings.clock.before_tick = settings.clock.period;
  EXPECT_EQ(problems(settings).size(), 1U);
}

TEST(SimulatedImu, WithAClockOfItsOwnDeliversTheNewestOfNoneOneOrTwoSamplesATick) {
  SimulatedImuSettings settings;
  settings.accelerometer_density = settings.gyroscope_density = 0.0;
  settings.accelerometer_bias = settings.gyroscope_bias = 0.0;
  settings.accelerometer_resolution = settings.gyroscope_resolution = 0.0;
  for (const Time period : {1250us, 625us, 313us}) {
    settings.clock = {.period = period, .before_tick = 200us};
    Imu imu(settings);
    for (int k = 0; k < 100; ++k) {
      const ImuReading reading = imu.read(moving_truth(1e-3 * k));
      const Time newest = (1ms * k - settings.delay + 200us) / period * period - 200us;
      if (1ms * k < settings.delay + 1ms) continue;
      ASSERT_TRUE(reading.valid) << k;
      EXPECT_EQ(reading.acquired, newest);
      const double t = to_seconds(newest);
      SimulatedImuSettings prompt = settings;
      prompt.clock = {};
      prompt.delay = Time::zero();
      const ImuReading then = Imu(prompt).read(moving_truth(t));
      EXPECT_LT((reading.angular_velocity - then.angular_velocity).norm(), 1e-4);
      EXPECT_LT((reading.specific_force - then.specific_force).norm(), 0.2)
          << "with the acceleration of the tick";
    }
  }
}

TEST(SimulatedImu, SaysOfItsSamplesAnotherTimeThanTheirs) {
  SimulatedImuSettings settings;
  settings.accelerometer_density = settings.gyroscope_density = 0.0;
  settings.clock = {.period = 625us, .jitter = 80us, .stamp_jitter = 150us};
  const ImuClock clock(settings.clock, derive_seed(1, "clock"));
  Imu imu(settings);
  int other = 0;
  for (int k = 0; k < 100; ++k) {
    const Time due = imu.now() - settings.delay;
    const ImuReading reading = imu.read(moving_truth(to_seconds(imu.now())));
    std::int64_t number = clock.number_at(due);
    while (clock.sample(number + 1).measured <= due) ++number;
    if (k < 5) continue;
    ASSERT_TRUE(reading.valid) << k;
    EXPECT_EQ(reading.acquired, clock.sample(number).stamp);
    other += reading.acquired != clock.sample(number).measured ? 1 : 0;
  }
  EXPECT_GT(other, 50);
}

TEST(SimulatedImu, HoldsItsSamplesBetweenPeriods) {
  SimulatedImuSettings settings = without_errors();
  settings.clock.period = 2ms;
  Imu imu(settings);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(imu.read(moving_truth(1e-3 * k)).acquired, 2ms * (k / 2));
}

TEST(SimulatedImu, NoiseHasTheDeviationOfItsDensityAndBiasesStayWithinTheirLimits) {
  SimulatedImuSettings settings;
  settings.delay = Time::zero();
  settings.angles.setZero();
  Imu imu(settings);
  test::Statistics force;
  test::Statistics rate;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    const ImuReading reading = imu.read();
    force.add(reading.specific_force.z());
    rate.add(reading.angular_velocity.x());
  }
  const double force_sigma = 0.0395;                                  // [m/s^2] at 1 kHz
  const double rate_sigma = 0.1565 * 3.14159265358979323846 / 180.0;  // [rad/s]
  EXPECT_NEAR(force.deviation(), force_sigma, 0.03 * force_sigma);
  EXPECT_NEAR(rate.deviation(), rate_sigma, 0.03 * rate_sigma);
  EXPECT_NEAR(force.mean(), 9.81 + imu.block().accelerometer_bias().z(),
              4.0 * force_sigma / std::sqrt(samples));
  EXPECT_NEAR(rate.mean(), imu.block().gyroscope_bias().x(), 4.0 * rate_sigma / std::sqrt(samples));

  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const SimulatedImu each(settings, *test::individual_rig(), seed);
    EXPECT_LE(each.accelerometer_bias().cwiseAbs().maxCoeff(), settings.accelerometer_bias);
    EXPECT_GT(each.accelerometer_bias().norm(), 0.0);
    EXPECT_LE(each.gyroscope_bias().cwiseAbs().maxCoeff(), settings.gyroscope_bias);
  }
  settings.fixed_accelerometer_bias = Eigen::Vector3d(0.3, -0.2, 0.1);
  EXPECT_EQ(SimulatedImu(settings, *test::individual_rig(), 1).accelerometer_bias(),
            Eigen::Vector3d(0.3, -0.2, 0.1));
}

TEST(SimulatedImu, QuantisesWithItsResolutions) {
  SimulatedImuSettings settings;
  settings.delay = Time::zero();
  Imu imu(settings);
  for (int k = 0; k < 100; ++k) {
    const ImuReading reading = imu.read(moving_truth(1e-3 * k));
    const Eigen::Vector3d force_steps = reading.specific_force / settings.accelerometer_resolution;
    const Eigen::Vector3d rate_steps = reading.angular_velocity / settings.gyroscope_resolution;
    EXPECT_TRUE(force_steps.isApprox(force_steps.array().round().matrix(), 1e-9));
    EXPECT_NEAR((rate_steps - rate_steps.array().round().matrix()).norm(), 0.0, 1e-9);
  }
}

TEST(SimulatedImu, HasNoiseOfItsOwnInEachSampleOfATick) {
  SimulatedImuSettings settings;
  settings.clock.period = 250us;
  Imu imu(settings);
  test::Statistics force;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int k = 0; k < 20000; ++k) {
    const ImuReading reading = imu.read();
    if (!reading.valid) continue;
    force.add(reading.specific_force.x());
    EXPECT_NE(reading.specific_force, before);
    before = reading.specific_force;
  }
  EXPECT_NEAR(force.deviation(), 2.0 * 0.0395, 0.03 * 2.0 * 0.0395) << "of the same density";
}

TEST(SimulatedImu, IsTheSameForTheSameSeedOnly) {
  SimulatedImuSettings settings;
  settings.delay = Time::zero();
  Imu a(settings, 5);
  Imu b(settings, 5);
  Imu c(settings, 6);
  for (int k = 0; k < 10; ++k) {
    const ImuReading reading = a.read();
    EXPECT_EQ(reading.specific_force, b.read().specific_force);
    EXPECT_NE(reading.specific_force, c.read().specific_force);
  }
}

TEST(SimulatedImu, RefusesADelayLongerThanItsMemory) {
  SimulatedImuSettings settings;
  settings.delay = 20ms;
  EXPECT_THROW(SimulatedImu(settings, *test::individual_rig(), 1), SetupError);
  settings.clock.period = Time::zero();
  EXPECT_EQ(problems(settings).size(), 2U);
  settings = SimulatedImuSettings();
  settings.clock.period = 62us;
  EXPECT_THROW(SimulatedImu(settings, *test::individual_rig(), 1), SetupError) << "too many in a tick";
}

}  // namespace
}  // namespace flinch
