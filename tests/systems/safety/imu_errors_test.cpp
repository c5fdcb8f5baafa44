#include "systems/safety/imu_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr ImuSpread spread{.force = 0.04, .turning = 3e-3};

Eigen::Vector3d noise(RandomGenerator& random, double deviation) {
  return deviation * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

/// What is expected in a motion with 8 m/s^2 and 2 rad/s, and the errors of a unit that `failure` spoils.
ImuErrors errors_of(const std::function<void(double time, ImuError&)>& failure, double deviations = 1.0) {
  RandomGenerator random(3);
  ImuErrors errors;
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
            ImuDoubt::biased);
  EXPECT_EQ(explanation(errors_of([](double, ImuError& error) { error.turning.z() -= 0.2; }), spread),
            ImuDoubt::biased);
  const auto late = errors_of([](double, ImuError& error) {
    error.force -= 2e-3 * error.force_slope;
    error.turning -= 2e-3 * error.turning_slope;
  });
  EXPECT_EQ(explanation(late, spread), ImuDoubt::late);
  const Eigen::Vector3d angle(0.05, -0.1, 0.2);
  const auto turned = errors_of([&angle](double, ImuError& error) {
    error.force += angle.cross(error.expected_force);
    error.turning += angle.cross(error.expected_turning);
  });
  EXPECT_EQ(explanation(turned, spread), ImuDoubt::turned);
  const auto odd =
      errors_of([](double time, ImuError& error) { error.force.x() += 5.0 * std::sin(3000.0 * time); });
  EXPECT_EQ(explanation(odd, spread), ImuDoubt::contradicted);
}

TEST(ImuErrors, CountsThoseThatAreContradicted) {
  ImuErrors errors;
  for (int k = 0; k < 20; ++k) {
    errors.push({});
    errors.latest().contradicted = k >= 15;
  }
  EXPECT_EQ(errors.held(), ImuErrors::most);
  EXPECT_EQ(errors.contradicted(), 5);
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

}  // namespace
}  // namespace flinch
