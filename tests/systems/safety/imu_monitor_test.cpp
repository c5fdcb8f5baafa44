#include "systems/safety/imu_monitor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "systems/framework/random.h"
#include "systems/robot/imu_output.h"
#include "systems/safety/plausibility_monitor.h"
#include "tests/support/allocations.h"
#include "tests/systems/safety/monitored.h"

namespace flinch {
namespace {

constexpr int delay = 4;                // of the unit [ticks]
constexpr double angle_noise = 7e-6;    // [rad]
constexpr double force_noise = 0.04;    // [m/s^2]
constexpr double turning_noise = 3e-3;  // [rad/s]

/// When the unit samples, and by how much its stamps may be wrong.
struct Clock {
  Time period = 1ms;
  Time phase{};  ///< of the first sample
  Time jitter{};
  double steps = 0.0;  ///< deviation of what drives add at once at each tick [m/s^2]
};

using Failure = std::function<void(int tick, ImuReading&)>;

/// A robot that moves round a curve, which drives and an outer wrench make together; its unit is some ticks
/// late, and `failure` spoils what it says.
class Moving {
 public:
  explicit Moving(const Clock& clock = {}) : clock_(clock), next_(clock.phase) {
    for (int k = 0; k < 200; ++k) tick();
  }
  bool braked() const { return tick_ < 100; }

  /// `pull` [m/s^2] is what the outer wrench makes of the platform's acceleration.
  const Plausibility& tick(const Failure& failure = {}, double pull = 0.0, bool reset = false) {
    const auto [pose, velocity, acceleration] = motion_at(1e-3 * (tick_ - 100));
    test::Posture posture(*monitor_.robot, pose, velocity, monitor_.ticking.now());
    const Eigen::Vector3d driven =
        acceleration - Eigen::Vector3d(pull, 0.0, 0.0) + held_until(monitor_.ticking.now());
    const JointVector torque =
        posture.kinematics.J_x_qa.transpose() *
        (posture.dynamics.M_x * driven + posture.dynamics.C_x * velocity + posture.dynamics.g_x);
    set_encoders(posture);
    monitor_.ticking.set(monitor_.torque, DriveTorque{monitor_.ticking.now(), true, torque, braked()});
    set_unit(failure);
    const bool held = braked();
    monitor_.ticking.set(
        monitor_.station,
        StationStatus{.acquired = monitor_.ticking.now(), .valid = true, .enabled = true, .braked = held});
    monitor_.ticking.set(monitor_.brake, BrakeCommand{.engage = held});
    monitor_.ticking.set(monitor_.gate, GateStatus{.phase = GatePhase::open, .reaction = GateReaction::none});
    monitor_.ticking.set(monitor_.commanded, TorqueCommand());
    monitor_.ticking.set(monitor_.drives, DriveReading());
    monitor_.ticking.set(monitor_.reset, ResetCommand{.reset = reset});
    monitor_.ticking.tick();
    ++tick_;
    return monitor_.ticking.get(monitor_.block.plausibility);
  }

  const ImuReading& believed() const { return monitor_.ticking.get(monitor_.block.believed_imu); }
  bool is_late_enough() const { return tick_ > 150; }

 private:
  struct Motion {
    Eigen::Vector3d pose, velocity, acceleration;
  };
  /// So many seconds after the brakes open; before, it rests.
  static Motion motion_at(double t) {
    constexpr double w = 12.0;
    const Eigen::Vector3d amplitude(0.06, 0.05, 0.2), none(0.0, 0.0, 0.0);
    if (t < 0.0) return {none, none, none};
    return {amplitude * (1.0 - std::cos(w * t)), w * amplitude * std::sin(w * t),
            w * w * amplitude * std::cos(w * t)};
  }

  void set_encoders(test::Posture& posture) {
    JointVector off = JointVector::Zero(3);
    for (double& each : off) each = angle_noise * random_.normal();
    posture.joints.active += off;
    posture.platform.pose += posture.kinematics.J_x_qa * off;
    monitor_.ticking.set(monitor_.joints, posture.joints);
    monitor_.ticking.set(monitor_.platform, posture.platform);
    monitor_.ticking.set(monitor_.kinematics, posture.kinematics);
    monitor_.ticking.set(monitor_.dynamics, posture.dynamics);
  }

  /// What the drives make of the acceleration in the tick until `time`, beside the motion, which is hardly
  /// touched by it: a white one of 1 m/s^2 shifts by half a micrometre in a tick.
  Eigen::Vector3d held_until(Time time) const {
    if (clock_.steps == 0.0 || time <= 100ms) return Eigen::Vector3d::Zero();
    RandomGenerator of_tick(static_cast<std::uint64_t>((time + 1ms - 1ns) / 1ms));
    return clock_.steps * Eigen::Vector3d(of_tick.normal(), of_tick.normal(), 0.0);
  }

  void set_unit(const Failure& failure) {
    const Time now = monitor_.ticking.now();
    for (; next_ <= now; next_ += clock_.period) underway_.push_back({next_, sample(next_)});
    while (underway_.size() > 1 && underway_[1].measured <= now - delay * 1ms) underway_.pop_front();
    ImuReading arrived;
    if (!underway_.empty() && underway_.front().measured <= now - delay * 1ms)
      arrived = underway_.front().reading;
    if (failure && arrived.valid) failure(tick_, arrived);
    monitor_.ticking.set(monitor_.imu, arrived);
  }
  ImuReading sample(Time time) {
    const auto [pose, velocity, acceleration] = motion_at(to_seconds(time - 100ms));
    const ImuOutput output = imu_output(monitor_.robot->space(), ImuMount{}, monitor_.robot->gravity(), pose,
                                        velocity, acceleration + held_until(time));
    ImuReading fresh{time, true, output.value.head<3>(), output.value.tail<3>()};
    for (double& each : fresh.angular_velocity) each += turning_noise * random_.normal();
    for (double& each : fresh.specific_force) each += force_noise * random_.normal();
    if (clock_.jitter > Time::zero())
      fresh.acquired += from_seconds(random_.uniform(-1.0, 1.0) * to_seconds(clock_.jitter));
    return fresh;
  }

  struct Underway {
    Time measured{};
    ImuReading reading;
  };

  test::Monitored monitor_{PlausibilityLimits()};
  RandomGenerator random_{1};
  Clock clock_;
  Time next_;
  std::deque<Underway> underway_;
  int tick_ = 0;
};

/// Ticks until the unit is in doubt, 0 for the first; none within 60.
std::optional<int> ticks_until(Moving& moving, ImuFault doubt, const Failure& failure) {
  for (int k = 0; k < 60; ++k) {
    const Plausibility& found = moving.tick(failure);
    EXPECT_EQ(found.present, FaultMask{0}) << "nothing stops";
    if (found.imu_doubt == ImuFault::none) continue;
    EXPECT_STREQ(name(found.imu_doubt), name(doubt));
    EXPECT_FALSE(moving.believed().valid);
    return k;
  }
  return std::nullopt;
}

TEST(ImuMonitor, BelievesAnHonestUnitInMotionAndInContact) {
  Moving moving;
  int left_out = 0;
  for (int k = 0; k < 3000; ++k) {
    const double since = k % 500;  // twenty newtons in 10 ms, for 20 ms, and back; then half a sine of 12 ms
    double pull = std::clamp(since / 10.0, 0.0, 1.0) * std::clamp((40.0 - since) / 10.0, 0.0, 1.0) * 7.0;
    if (since > 100.0 && since < 112.0) pull = 40.0 * std::sin((since - 100.0) / 12.0 * 3.141592653589793);
    const Plausibility& found = moving.tick({}, pull);
    ASSERT_EQ(found.imu_doubt, ImuFault::none) << k;
    left_out += found.imu_left_out ? 1 : 0;
    if (!found.imu_left_out) {
      EXPECT_TRUE(moving.believed().valid);
    }
  }
  EXPECT_LT(left_out, 30) << "one tick in a hundred";
}

// The BMI160 samples with 1.6 kHz of its own, of which every tick delivers the latest.
TEST(ImuMonitor, BelievesAnHonestUnitWhateverItsClock) {
  std::vector<Clock> clocks{{.jitter = 100us}, {.period = 625us}, {.period = 625us, .phase = 200us}};
  for (const Time phase : {60us, 125us, 250us, 312us, 500us, 750us, 940us})
    clocks.push_back({.phase = phase});
  for (const Clock& clock : clocks) {
    Moving moving(clock);
    int left_out = 0;
    for (int k = 0; k < 1500; ++k) {
      const Plausibility& found = moving.tick();
      ASSERT_EQ(found.present, FaultMask{0});
      ASSERT_EQ(found.imu_doubt, ImuFault::none) << to_seconds(clock.phase) << " s, " << k;
      left_out += found.imu_left_out ? 1 : 0;
    }
    EXPECT_LE(left_out, 1) << to_seconds(clock.period) << " s, " << to_seconds(clock.phase) << " s";
  }
}

// Drives that step at the tick: a sample just after it sees the whole step, of which nobody could be sure.
TEST(ImuMonitor, BelievesAnHonestUnitThatSeesStepsOfTheDrives) {
  for (const Clock& clock :
       {Clock{.steps = 1.0}, Clock{.phase = 60us, .steps = 1.0}, Clock{.phase = 300us, .steps = 1.0},
        Clock{.period = 625us, .steps = 1.0}, Clock{.period = 625us, .jitter = 100us, .steps = 1.0}}) {
    Moving moving(clock);
    for (int k = 0; k < 1500; ++k) {
      const ImuFault doubt = moving.tick().imu_doubt;
      ASSERT_STREQ(name(doubt), name(ImuFault::none))
          << to_seconds(clock.period) << " s, " << to_seconds(clock.phase) << " s, " << k;
    }
  }
}

/// The largest change of velocity that encoders and accelerometer tell apart, in its limit.
double apart_of(const Clock& clock) {
  Moving moving(clock);
  double largest = 0.0;
  for (int k = 0; k < 1500; ++k)
    largest = std::max(largest, moving.tick().of(PlausibilityCheck::accelerometer));
  return largest;
}

TEST(InertialMonitor, SumsUpAccelerationsByTheTimesOfTheSamples) {
  const double on_ticks = apart_of({});
  EXPECT_GT(on_ticks, 0.0);
  for (const Clock& clock : {Clock{.period = 625us}, Clock{.period = 1230us}, Clock{.phase = 500us}}) {
    const double apart = apart_of(clock);
    std::printf("  %.2f ms, %.2f ms after the tick: %.3f of the limit; on the ticks %.3f\n",
                1e3 * to_seconds(clock.period), 1e3 * to_seconds(clock.phase), apart, on_ticks);
    EXPECT_LT(apart, 1.1 * on_ticks);
  }
}

TEST(ImuMonitor, NamesWhatIsWrongBetweenTicksAsWell) {
  for (const Clock& clock : {Clock{.phase = 400us}, Clock{.period = 625us}}) {
    Moving moving(clock);
    const auto found =
        ticks_until(moving, ImuFault::biased, [](int, ImuReading& imu) { imu.specific_force.x() += 3.0; });
    ASSERT_TRUE(found.has_value());
    EXPECT_LE(*found, 8);
  }
}

TEST(ImuMonitor, NamesWhatIsWrongWithinTwentyTicks) {
  const auto expect = [](ImuFault doubt, const Failure& failure, int within) {
    Moving moving;
    const auto found = ticks_until(moving, doubt, failure);
    ASSERT_TRUE(found.has_value()) << name(doubt);
    EXPECT_LE(*found, within) << name(doubt);
  };
  expect(
      ImuFault::dropped_out, [](int, ImuReading& imu) { imu.valid = false; }, 4);
  std::optional<ImuReading> first;
  expect(
      ImuFault::frozen,
      [&first](int, ImuReading& imu) {
        if (!first) first = imu;
        imu.specific_force = first->specific_force;
        imu.angular_velocity = first->angular_velocity;
      },
      3);
  expect(
      ImuFault::saturated,
      [](int, ImuReading& imu) {
        imu.specific_force.head(2) = imu.specific_force.head(2).cwiseMin(4.0).cwiseMax(-4.0);
      },
      20);
  expect(
      ImuFault::biased, [](int, ImuReading& imu) { imu.specific_force.x() += 3.0; }, 8);
  expect(
      ImuFault::biased, [](int, ImuReading& imu) { imu.angular_velocity.z() -= 0.2; }, 8);
  RandomGenerator random(9);
  expect(
      ImuFault::noisy,
      [&random](int, ImuReading& imu) {
        for (double& each : imu.specific_force) each += 10.0 * force_noise * random.normal();
        for (double& each : imu.angular_velocity) each += 10.0 * turning_noise * random.normal();
      },
      20);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  expect(
      ImuFault::turned,
      [&turned](int, ImuReading& imu) {
        imu.specific_force = turned * imu.specific_force;
        imu.angular_velocity = turned * imu.angular_velocity;
      },
      20);
}

TEST(ImuMonitor, LeavesOutTheFirstSampleThatClaimsAContactWhichTheEncodersDoNotShow) {
  Moving moving;
  const auto off = [](int, ImuReading& imu) { imu.specific_force.y() += 2.5; };
  EXPECT_TRUE(moving.tick(off).imu_left_out);
  EXPECT_FALSE(moving.believed().valid);
}

TEST(ImuMonitor, LeavesOutTheFirstSampleWhoseRateJumpsAsTheEncodersDoNot) {
  Moving moving;
  const auto off = [](int, ImuReading& imu) { imu.angular_velocity.z() += 0.06; };
  EXPECT_TRUE(moving.tick(off).imu_left_out);
}

TEST(ImuMonitor, NamesAUnitThatIsLate) {
  Moving moving;
  std::vector<ImuReading> held;
  const auto late = [&held](int, ImuReading& imu) {
    held.push_back(imu);
    const ImuReading& then = held[held.size() < 3 ? 0 : held.size() - 3];
    imu.specific_force = then.specific_force;
    imu.angular_velocity = then.angular_velocity;
  };
  for (int k = 0; k < 5; ++k) {  // a unit that is on time, to have something to be late with
    moving.tick([&held](int, ImuReading& imu) { held.push_back(imu); });
  }
  const auto found = ticks_until(moving, ImuFault::late, late);
  ASSERT_TRUE(found.has_value());
  EXPECT_LE(*found, 20);
}

TEST(ImuMonitor, BelievesAgainOnceTheOperatorResets) {
  Moving moving;
  const auto off = [](int, ImuReading& imu) { imu.specific_force.x() += 5.0; };
  ASSERT_TRUE(ticks_until(moving, ImuFault::biased, off).has_value());
  for (int k = 0; k < 50; ++k)
    EXPECT_EQ(moving.tick().imu_doubt, ImuFault::biased) << "though it is honest again";
  moving.tick({}, 0.0, true);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(moving.tick().imu_doubt, ImuFault::none);
  EXPECT_TRUE(moving.believed().valid);
}

TEST(ImuMonitor, BelievesAUnitThatComesBackAfterItDroppedOut) {
  Moving moving;
  ASSERT_TRUE(ticks_until(moving, ImuFault::dropped_out, [](int, ImuReading& imu) {
                imu.valid = false;
              }).has_value());
  for (int k = 0; k < 25; ++k) moving.tick();
  EXPECT_EQ(moving.tick().imu_doubt, ImuFault::none);
}

TEST(ImuMonitor, DoesNotJudgeAReadingOfLongAgo) {
  const auto robot = test::planar_rig();
  const PlausibilityLimits limits;
  const MountedImu mounted(limits.imu_mount);
  InertialMonitor learned;
  for (const double off : {1.0, -1.0}) {
    for (int k = 0; k < LearnedNoise::enough; ++k) {
      learned.gyroscope.add(Eigen::Vector3d::Constant(off * turning_noise));
      learned.accelerometer.add(Eigen::Vector3d::Constant(off * force_noise));
    }
  }
  const AngleMonitor angles;
  ImuMonitor watch;
  ImuMonitor::Past past;
  Plausibility found;
  Time now = 24h;
  const auto tick = [&](const ImuReading& imu) {  // of a robot at rest
    test::Posture posture(*robot, PlatformVector::Zero(3), PlatformVector::Zero(3), now);
    const JointVector holding = posture.kinematics.J_x_qa.transpose() * posture.dynamics.g_x;
    const DriveTorque torque{now, true, holding, false};
    const DriveReading drives;
    found = {};
    advance(watch, past, learned, angles,
            {.robot = *robot,
             .limits = limits,
             .mounted = mounted,
             .now = now,
             .period = 1ms,
             .joints = posture.joints,
             .drives = drives,
             .torque = torque,
             .imu = imu,
             .platform = posture.platform,
             .kinematics = posture.kinematics,
             .dynamics = posture.dynamics,
             .held = false,
             .free = true},
            found);
    watch.motion.keep_in(past.motion);
    watch.errors.keep_in(past.errors);
    now += 1ms;
  };
  for (int k = 0; k < 20000; ++k) tick({});
  double absurd = 1.0;  // other values each time, which are not frozen
  const auto reading = [&absurd](Time acquired) {
    absurd += 1.0;
    return ImuReading{acquired, true, absurd * Eigen::Vector3d(1.0, 2.0, 3.0),
                      absurd * Eigen::Vector3d(20.0, 10.0, 30.0)};
  };
  for (const Time ago : {Time(1h), Time(15s), Time(10ms)}) {
    tick(reading(now - ago));
    EXPECT_EQ(watch.errors.count, 0U) << to_seconds(ago) << " s ago";
    EXPECT_FALSE(found.imu_left_out) << to_seconds(ago) << " s ago";
  }
  tick(reading(now - 4ms));
  ASSERT_EQ(watch.errors.count, 1U) << "of now, it is judged";
  EXPECT_TRUE(watch.errors.newest.contradicted);
  EXPECT_TRUE(found.imu_left_out);
}

/// Against a parabola fitted to the samples by least squares.
TEST(ParabolaWeights, GiveTheSecondDerivativeOfTheFittedParabola) {
  RandomGenerator random(2);
  for (const int h : {2, 3, 4, 6}) {
    const int n = 2 * h + 1;
    Eigen::MatrixXd columns(n, 3);
    Eigen::VectorXd samples(n);
    for (int i = 0; i < n; ++i) {
      columns.row(i) << 1.0, i - h, 0.5 * (i - h) * (i - h);
      samples[i] = random.normal();
    }
    const double fitted = columns.colPivHouseholderQr().solve(samples)[2];
    double mean = 0.0;
    for (int i = 1 - h; i < h; ++i)
      mean += parabola_weight(h, i) * (samples[h + i + 1] - 2.0 * samples[h + i] + samples[h + i - 1]);
    EXPECT_NEAR(mean, fitted, 1e-12) << h;
  }
}

}  // namespace
}  // namespace flinch
