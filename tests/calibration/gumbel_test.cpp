#include "calibration/gumbel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace flinch {
namespace {

std::vector<double> drawn(std::mt19937_64& random, std::size_t count, double location, double scale) {
  std::extreme_value_distribution<double> gumbel(location, scale);
  std::vector<double> values(count);
  for (double& value : values) value = gumbel(random);
  return values;
}

TEST(Gumbel, IsExceededAsOftenAsItSays) {
  const Gumbel gumbel{.location = 3.0, .scale = 0.7};
  for (const double probability : {0.5, 0.1, 1e-4, 1e-9}) {
    const double x = gumbel.quantile_above(probability);
    EXPECT_NEAR(-std::expm1(-std::exp(-(x - 3.0) / 0.7)), probability, 1e-12 * probability + 1e-16);
    EXPECT_NEAR(gumbel.probability_above(x) / probability, 1.0, 1e-6);
  }
}

TEST(AFitToQuartiles, IsHardlyMovedByAFewMaximaOfSomethingElse) {
  std::mt19937_64 random(3);
  std::vector<double> maxima = drawn(random, 2000, 3.0, 0.7);
  for (int i = 0; i < 40; ++i) maxima[static_cast<std::size_t>(50 * i)] = 50.0;
  const Gumbel fit = fit_gumbel_to_quartiles(maxima);
  EXPECT_NEAR(fit.location, 3.0, 0.05);
  EXPECT_NEAR(fit.scale, 0.7, 0.05);
  EXPECT_GT(fit_gumbel(maxima).scale, 1.0) << "by moments it is";
}

TEST(TheFit, FindsWhatTheMaximaWereDrawnFrom) {
  std::mt19937_64 random(1);
  const Gumbel fit = fit_gumbel(drawn(random, 200'000, 3.0, 0.7));
  EXPECT_NEAR(fit.location, 3.0, 0.01);
  EXPECT_NEAR(fit.scale, 0.7, 0.01);
}

TEST(TheFit, OfTwoValuesIsDoneByHand) {
  // Mean 2, second L-moment half the mean difference: 0.5.
  const std::vector<double> two = {2.5, 1.5};
  EXPECT_NEAR(fit_gumbel(two).scale, 0.5 / std::log(2.0), 1e-15);
}

TEST(TheUpperBound, LiesAboveTheTrueQuantileAsOftenAsItSays) {
  std::mt19937_64 random(2);
  const double truth = Gumbel{3.0, 0.7}.quantile_above(1e-4);
  for (const double confidence : {0.5, 0.95}) {
    int above = 0;
    constexpr int trials = 3000;
    for (int i = 0; i < trials; ++i) {
      const Gumbel fit = fit_gumbel(drawn(random, 180, 3.0, 0.7));
      above += upper_quantile_above(fit, 180, 1e-4, confidence) >= truth ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(above) / trials, confidence, 0.025);
  }
}

TEST(TheUpperBound, HoldsForFewMaximaToo) {
  std::mt19937_64 random(3);
  const double truth = Gumbel{3.0, 0.7}.quantile_above(3.5e-5);
  for (const std::size_t maxima : {14U, 30U, 60U}) {
    int above = 0;
    constexpr int trials = 3000;
    for (int i = 0; i < trials; ++i) {
      const Gumbel fit = fit_gumbel(drawn(random, maxima, 3.0, 0.7));
      above += upper_quantile_above(fit, maxima, 3.5e-5, 0.95) >= truth ? 1 : 0;
    }
    EXPECT_GE(static_cast<double>(above) / trials, 0.92) << maxima;  // 93.1, 93.7 and 94.5 % of 6000
    EXPECT_LE(static_cast<double>(above) / trials, 0.97) << maxima;
  }
}

}  // namespace
}  // namespace flinch
