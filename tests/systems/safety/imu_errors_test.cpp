#include "systems/safety/imu_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr ImuSpread spread{.force = 0.04, .turning = 3e-3};

Eigen::Vector3d noise(RandomGenerator& random, double deviation) {
  return deviation * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

/// Errors of one sample after the other.
class Samples {
 public:
  void push(const ImuError& error) {
    ring_.keep_in(past_);
    ring_.push(error);
  }
  ImuError& latest() { return ring_.newest; }
  operator ImuErrors() const { return {ring_, past_}; }

 private:
  Ring<ImuError, ImuErrors::most> ring_;
  std::array<ImuError, ImuErrors::most> past_{};
};

/// What is expected in a motion with 8 m/s^2 and 2 rad/s, and the errors of a unit that `failure` spoils.
Samples errors_of(const std::function<void(double time, ImuError&)>& failure, double deviations = 1.0) {
  RandomGenerator random(3);
  Samples errors;
  for (int k = 0; k < 40; ++k) {
    const double t = 1e-3 * k, w = 40.0;
    ImuError error;
    error.expected_force = Eigen::Vector3d(8.0 * std::cos(w * t), 8.0 * std::sin(w * t), 9.81);
    error.force_slope = 8.0 * w * Eigen::Vector3d(-std::sin(w * t), std::cos(w * t), 0.0);
    error.expected_turning = Eigen::Vector3d(0.0, 0.0, 2.0 * std::cos(w * t));
    error.turning_slope = Eigen::Vector3d(0.0, 0.0, -2.0 * w * std::sin(w * t));
    error.force = noise(random, deviations * spread.force);
    error.turning = noise(random, deviations * spread.turning);
    error.contradicted = true;
    failure(t, error);
    errors.push(error);
    errors.latest().jumps = jumped(errors, 0, spread);
  }
  return errors;
}

TEST(ImuErrors, AreExplainedByWhatMadeThem) {
  EXPECT_EQ(explanation(errors_of([](double, ImuError& error) { error.force.x() += 3.0; }), spread),
            ImuFault::biased);
  EXPECT_EQ(explanation(errors_of([](double, ImuError& error) { error.turning.z() -= 0.2; }), spread),
            ImuFault::biased);
  const auto late = errors_of([](double, ImuError& error) {
    error.force -= 2e-3 * error.force_slope;
    error.turning -= 2e-3 * error.turning_slope;
  });
  EXPECT_EQ(explanation(late, spread), ImuFault::late);
  const Eigen::Vector3d angle(0.05, -0.1, 0.2);
  const auto turned = errors_of([&angle](double, ImuError& error) {
    error.force += angle.cross(error.expected_force);
    error.turning += angle.cross(error.expected_turning);
  });
  EXPECT_EQ(explanation(turned, spread), ImuFault::turned);
  const auto odd = [](double rate) {
    return errors_of(
        [rate](double time, ImuError& error) { error.force.x() += 5.0 * std::sin(rate * time); });
  };
  EXPECT_EQ(explanation(odd(600.0), spread), ImuFault::contradicted);
  EXPECT_EQ(explanation(odd(3000.0), spread), ImuFault::noisy) << "it jumps to and fro";
}

TEST(ImuErrors, CountsThoseThatAreContradicted) {
  Samples errors;
  for (int k = 0; k < 20; ++k) {
    errors.push({});
    errors.latest().contradicted = k >= 15;
  }
  EXPECT_EQ(ImuErrors(errors).held(), ImuErrors::most);
  EXPECT_EQ(ImuErrors(errors).contradicted(), 5);
}

TEST(ImuErrors, JumpWithTenfoldNoiseOnly) {
  const auto nothing = [](double, ImuError&) {};
  EXPECT_FALSE(jumps(errors_of(nothing)));
  EXPECT_TRUE(jumps(errors_of(nothing, 10.0)));
  const auto contact = [](double time, ImuError& error) {
    error.force.x() += 100.0 * std::sin(300.0 * time);
  };
  EXPECT_FALSE(jumps(errors_of(contact))) << "half a sine of 10 ms, as of a hard contact";
}

/// A unit on a platform that motors shake by `ripple` to and fro, whose noise grows tenfold after 0.6 s
/// where it `fails`. The first sample at which it is known to jump; none: 0.
int first_jump(const std::function<double(double time)>& ripple, bool fails) {
  RandomGenerator random(5);
  Samples errors;
  UsualBends usual;
  for (int k = 0; k < 1000; ++k) {
    const double t = 1e-3 * k;
    ImuError error;
    const double deviations = fails && k >= 600 ? 10.0 : 1.0;
    error.force = noise(random, deviations * spread.force);
    error.turning = noise(random, deviations * spread.turning);
    error.force.y() += (k % 2 == 0 ? 1.0 : -1.0) * ripple(t);
    errors.push(error);
    errors.latest().jumps = jumped(errors, 0, spread, usual);
    usual.follow(errors, spread);
    if (jumps(errors)) return k;
  }
  return 0;
}

TEST(UsualBends, AreLearnedOfMotorsThatShakeThePlatformAndNotOfAUnitThatFails) {
  const auto smooth = [](double) { return 0.0; };
  const auto shaken = [](double time) { return 10.0 * spread.force * std::min(time / 0.4, 1.0); };
  EXPECT_EQ(first_jump(smooth, false), 0);
  EXPECT_EQ(first_jump(shaken, false), 0) << "as it gets up to speed";
  const int found = first_jump(smooth, true);
  EXPECT_GE(found, 600);
  EXPECT_LE(found, 615);
}

constexpr double position_noise = 3e-6;  // of the encoders [m]
constexpr double angle_noise = 1e-5;     // [rad]
const EncoderSpread encoders{Eigen::Vector3d::Constant(position_noise),
                             Eigen::Vector3d::Constant(angle_noise)};

/// Samples of a platform that swings by `amplitude` [m, rad]; its unit is late by `delay`.
Samples swinging(double amplitude, double delay, std::uint64_t seed) {
  RandomGenerator random(seed);
  const double w = 40.0, T = 1e-3;
  const Eigen::Vector3d along(1.0, -0.5, 0.0), about(0.0, 0.0, 3.0);
  std::vector<Eigen::Vector3d> positions, angles;
  for (int k = 0; k < 42; ++k) {
    positions.push_back(amplitude * std::sin(w * T * k) * along + noise(random, position_noise));
    angles.push_back(amplitude * std::cos(w * T * k) * about + noise(random, angle_noise));
  }
  Samples errors;
  for (std::size_t k = 1; k < 41; ++k) {
    const double now = T * static_cast<double>(k), then = now - delay;
    ImuError error;  // of a model that expects no acceleration
    error.force = -amplitude * w * w * std::sin(w * then) * along + noise(random, spread.force);
    error.expected_turning = -amplitude * w * std::sin(w * now) * about;
    const Eigen::Vector3d turning =
        -amplitude * w * std::sin(w * then) * about + noise(random, spread.turning);
    error.turning = turning - error.expected_turning;
    error.force_unseen = error.force - (positions[k + 1] - 2.0 * positions[k] + positions[k - 1]) / (T * T);
    error.turning_unseen = turning - (angles[k + 1] - angles[k - 1]) / (2.0 * T);
    errors.push(error);
  }
  return errors;
}

TEST(Lateness, IsFoundWithTheDeviationThatItTells) {
  for (const double delay : {0.0, 0.5e-3, 2e-3}) {
    double squares = 0.0, sum = 0.0;
    constexpr int trials = 400;
    for (int i = 0; i < trials; ++i) {
      const auto errors = swinging(1e-3, delay, 100 + static_cast<std::uint64_t>(i));
      const Lateness found = lateness(errors, 20, encoders, spread);
      sum += (found.time - delay) / trials;
      squares += std::pow((found.time - delay) / found.deviation, 2) / trials;
    }
    EXPECT_NEAR(sum, 0.0, 0.1e-3) << delay;
    EXPECT_NEAR(squares, 1.0, 0.4) << delay;
    EXPECT_LT(lateness(swinging(1e-3, delay, 1), 20, encoders, spread).deviation, 0.6e-3);
  }
}

TEST(Lateness, IsSureOnlyOfAUnitThatIsLateInMotion) {
  EXPECT_TRUE(is_late(swinging(5e-3, 2e-3, 1), encoders, spread));
  EXPECT_FALSE(is_late(swinging(5e-3, 0.0, 1), encoders, spread));
  EXPECT_FALSE(is_late(swinging(5e-3, 0.5e-3, 1), encoders, spread));
  EXPECT_FALSE(is_late(swinging(0.0, 2e-3, 1), encoders, spread)) << "at rest nobody can tell";
}

TEST(Lateness, IsNotKnownFromFewSamples) {
  Samples errors;
  for (int k = 0; k < 9; ++k) errors.push({});
  EXPECT_EQ(lateness(errors, 10, encoders, spread).deviation, 0.0);
  EXPECT_FALSE(is_late(errors, encoders, spread));
}

}  // namespace
}  // namespace flinch
