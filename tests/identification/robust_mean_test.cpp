#include "identification/robust_mean.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"

namespace flinch {
namespace {

Eigen::VectorXd noise(int count, double mean, double deviation, std::uint64_t seed) {
  RandomGenerator random(seed);
  Eigen::VectorXd x(count);
  for (double& value : x) value = mean + deviation * random.normal();
  return x;
}

TEST(RobustMean, IsTheMeanOfNormalNoiseWithItsDeviation) {
  const RobustMean got = robust_mean(noise(10000, 3.0, 0.5, 1));
  EXPECT_NEAR(got.value, 3.0, 3.0 * 0.5 / 100.0);
  EXPECT_NEAR(got.deviation, 0.5 / 100.0, 2e-4);
}

TEST(RobustMean, DoesNotSeeAFifthOfOutliers) {
  Eigen::VectorXd x = noise(1000, 3.0, 0.5, 2);
  x.head(200).array() += 1000.0;
  EXPECT_NEAR(robust_mean(x).value, 3.0, 0.1);
}

TEST(RobustMean, OfNothingIsNotANumber) { EXPECT_TRUE(std::isnan(robust_mean(Eigen::VectorXd()).value)); }

TEST(RobustDeviation, OfNormalValuesIsTheirs) {
  const Eigen::VectorXd x = noise(10000, 0.0, 2.0, 3);
  EXPECT_NEAR(robust_deviation({x.begin(), x.end()}), 2.0, 0.06);
}

}  // namespace
}  // namespace flinch
