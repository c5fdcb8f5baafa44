#include "systems/contact/residual_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"

namespace flinch {
namespace {

const DriveLoad load{.acquired = {},
                     .valid = true,
                     .rate = Eigen::Vector3d(2.0, -1.0, 0.0),
                     .torque = Eigen::Vector3d(10.0, -20.0, 5.0),
                     .friction = Eigen::Vector3d(0.6, -0.6, 0.0),
                     .friction_bounds = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
                     .inertia = Eigen::Vector3d(0.5, 0.4, 0.25),
                     .turning = Eigen::Vector3d(0.0, 3.0, 1.0)};

TEST(ErrorVariance, IsTheSumOfIndependentParts) {
  const DriveResidual seen{.effort = Eigen::Vector3d::Zero(),
                           .torque = Eigen::Vector3d(1.0, 3.0, 0.0),
                           .friction = Eigen::Vector3d(0.5, 0.0, 0.0),
                           .slope = Eigen::Vector3d(0.0, 0.0, 500.0),
                           .rising = Eigen::Vector3d::Zero(),
                           .rest = Eigen::Vector3d(0.0, 0.0, 0.5)};
  const ResidualErrors errors{.noise = 0.1,
                              .speed = 0.2,
                              .load = 0.01,
                              .torque = 0.5,
                              .friction = 0.4,
                              .lag = 2e-4,
                              .rest = 0.6,
                              .acceleration = 2.0,
                              .turning = 0.1};
  // 0.1^2 + (0.2 2)^2 + (0.01 10)^2 + (0.5 1)^2 + (0.4 0.5)^2; of the last also (0.6 0.5)^2;
  // of each (2 inertia)^2 and (0.1 turning)^2
  EXPECT_NEAR(errors.variance(error_features(load, seen, 0)), 0.01 + 0.16 + 0.01 + 0.25 + 0.04 + 1.0, 1e-15);
  EXPECT_NEAR(errors.variance(error_features(load, seen, 1)), 0.01 + 0.04 + 0.04 + 2.25 + 0.64 + 0.09, 1e-15);
  EXPECT_NEAR(errors.variance(error_features(load, seen, 2)), 0.01 + 0.0025 + 0.01 + 0.09 + 0.25 + 0.01,
              1e-15);
}

TEST(Distance, HasASquareThatIsChiSquareForErrorsAsAssumed) {
  RandomGenerator random(1);
  const ResidualErrors errors{.noise = 0.1,
                              .speed = 0.2,
                              .load = 0.01,
                              .torque = 0.5,
                              .friction = 0.4,
                              .lag = 2e-4,
                              .acceleration = 0.2};
  constexpr int trials = 20'000;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < trials; ++k) {
    DriveResidual seen{.effort = Eigen::Vector3d::Zero(),
                       .torque = Eigen::Vector3d::Constant(random.uniform(-3.0, 3.0)),
                       .friction = Eigen::Vector3d::Constant(random.uniform(-0.6, 0.6)),
                       .slope = Eigen::Vector3d::Constant(random.uniform(-1e3, 1e3)),
                       .rising = Eigen::Vector3d::Zero(),
                       .rest = Eigen::Vector3d::Zero()};
    const double rising = random.uniform(0.0, 0.5);
    seen.rising[k % 3] = std::sqrt(3.0) * rising;
    for (int i = 0; i < 3; ++i) {
      const ErrorFeatures features = error_features(load, seen, i);
      seen.effort[i] = std::sqrt(errors.variance(features)) * random.normal() + rising * random.normal();
    }
    const double square = std::pow(mahalanobis_distance(load, seen, errors), 2);
    EXPECT_NEAR(whitened(load, seen, errors).squaredNorm(), square, 1e-12 * square);
    sum += square / trials;
    squares += square * square / trials;
  }
  EXPECT_NEAR(sum, 3.0, 5.0 * std::sqrt(6.0 / trials)) << "mean of chi-square with three degrees of freedom";
  EXPECT_NEAR(squares - sum * sum, 6.0, 0.5) << "and its variance";
}

TEST(Distance, OfWhatIsNotFiniteIsInfinite) {
  const DriveResidual seen{.effort = Eigen::Vector3d(std::nan(""), 0.0, 0.0),
                           .torque = Eigen::Vector3d::Zero(),
                           .friction = Eigen::Vector3d::Zero(),
                           .slope = Eigen::Vector3d::Zero(),
                           .rising = Eigen::Vector3d::Zero(),
                           .rest = Eigen::Vector3d::Zero()};
  EXPECT_EQ(mahalanobis_distance(load, seen, {.noise = 1.0}), INFINITY);
}

}  // namespace
}  // namespace flinch
