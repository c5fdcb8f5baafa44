#include "calibration/error_sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "systems/framework/random.h"

namespace flinch {
namespace {

/// Samples of normal errors of these sizes, under loads that vary independently of one another.
std::vector<ErrorSample> samples_of(const ResidualErrors& truth, std::size_t count) {
  RandomGenerator random(3);
  std::vector<ErrorSample> samples(count);
  for (ErrorSample& sample : samples) {
    sample.features[0] = 1.0;
    const double scales[] = {0.0, 3.0, 40.0, 5.0, 0.6, 2000.0, 1.0, 0.8, 6.0};
    for (std::size_t j = 1; j < sample.features.size(); ++j)
      sample.features[j] = std::pow(random.uniform(0.0, scales[j]), 2);
    sample.squared = truth.variance(sample.features) * std::pow(random.normal(), 2);
  }
  return samples;
}

TEST(ErrorSizes, AreFoundFromSquares) {
  const ResidualErrors truth{.noise = 0.2,
                             .speed = 0.07,
                             .load = 0.006,
                             .torque = 0.05,
                             .friction = 0.4,
                             .lag = 2e-4,
                             .rest = 0.5,
                             .acceleration = 0.3,
                             .turning = 0.05};
  const ResidualErrors found = fit_error_sizes(samples_of(truth, 400'000));
  // A variance found from n squares has a deviation of sqrt(2 / n) of all of it; parts of it some times that.
  EXPECT_NEAR(found.noise, truth.noise, 0.05 * truth.noise);
  EXPECT_NEAR(found.speed, truth.speed, 0.05 * truth.speed);
  EXPECT_NEAR(found.load, truth.load, 0.05 * truth.load);
  EXPECT_NEAR(found.torque, truth.torque, 0.05 * truth.torque);
  EXPECT_NEAR(found.friction, truth.friction, 0.05 * truth.friction);
  EXPECT_NEAR(found.lag, truth.lag, 0.05 * truth.lag);
  EXPECT_NEAR(found.rest, truth.rest, 0.05 * truth.rest);
  EXPECT_NEAR(found.acceleration, truth.acceleration, 0.05 * truth.acceleration);
  EXPECT_NEAR(found.turning, truth.turning, 0.05 * truth.turning);
}

TEST(ErrorSizes, OfWhatExplainsNothingAreAlmostZero) {
  const ResidualErrors found = fit_error_sizes(samples_of({.noise = 0.2, .friction = 0.5}, 200'000));
  EXPECT_NEAR(found.noise, 0.2, 0.01);
  EXPECT_NEAR(found.friction, 0.5, 0.02);
  const double tenth = 0.1 * std::pow(0.2, 2);  // of the variance that is noise, even under the largest load
  EXPECT_LT(std::pow(3.0 * found.speed, 2), tenth);
  EXPECT_LT(std::pow(40.0 * found.load, 2), tenth);
  EXPECT_LT(std::pow(5.0 * found.torque, 2), tenth);
  EXPECT_LT(std::pow(2000.0 * found.lag, 2), tenth);
  EXPECT_LT(std::pow(1.0 * found.rest, 2), tenth);
  EXPECT_LT(std::pow(0.8 * found.acceleration, 2), tenth);
  EXPECT_LT(std::pow(6.0 * found.turning, 2), tenth);
}

/// Errors that are this share of a torque of 0 to 9 Nm, and nothing else.
std::vector<ErrorSample> shares_of_torque(double share) {
  std::vector<ErrorSample> samples(1000);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double torque = static_cast<double>(k % 10);
    samples[k] = {.squared = std::pow(share * torque, 2),
                  .features = {1.0, 0.0, 0.0, torque * torque, 0.0, 0.0, 0.0, 0.0}};
  }
  return samples;
}

TEST(ErrorSizes, HaveNoiseEvenWhereAllIsExplained) {
  const ResidualErrors found = fit_error_sizes(shares_of_torque(0.1));
  EXPECT_GT(found.noise, 0.0);
  EXPECT_NEAR(found.torque, 0.1 * std::sqrt(900.0 / 1000.0), 0.03);
}

// What hides a contact as large as the torque itself would be no detector.
TEST(ErrorSizes, AreNoLargerShareOfTheTorqueThanATorqueConstantMayErr) {
  const ResidualErrors found = fit_error_sizes(shares_of_torque(1.0));
  EXPECT_EQ(found.torque, 0.2);
  EXPECT_GT(found.noise, 1.0) << "the rest is noise";
}

}  // namespace
}  // namespace flinch
