#include "calibration/mahalanobis_tail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "calibration/gumbel.h"

namespace flinch {
namespace {

/// Of chi-square of 2, 3 or 6 degrees: how often it is above x.
double chi_square_above(double x, int degrees) {
  if (degrees == 2) return std::exp(-x / 2);
  if (degrees == 3)
    return std::erfc(std::sqrt(x / 2)) + std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-x / 2);
  return std::exp(-x / 2) * (1.0 + x / 2 + x * x / 8);
}

/// The square of Mahalanobis distances of errors whose variance is distributed log-normally about the
/// expected one, with this relative variance.
struct Squares {
  int drives;
  double variation;

  double above(double x) const {
    const double deviation = std::sqrt(std::log1p(variation));  // of the logarithm
    double sum = 0.0, weights = 0.0;
    for (double y = -6.0; y <= 6.0; y += 0.25) {
      const double weight = std::exp(-y * y / 2);
      sum += weight * chi_square_above(x / std::exp(deviation * y - deviation * deviation / 2), drives);
      weights += weight;
    }
    return sum / weights;
  }
  /// The largest of so many independent ones: many values, one for each of equal steps in probability.
  std::vector<double> largest_of(int samples, std::size_t count) const {
    constexpr double step = 0.02;
    std::vector<double> values(count);
    double x = 0.0, below = 0.0, before = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double wanted = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      while (below < wanted) {
        before = below;
        x += step;
        below = std::pow(1.0 - above(x), samples);
      }
      values[i] = x - step * (below - wanted) / (below - before);
    }
    return values;
  }
};

constexpr std::size_t many = 20'000;
constexpr double asked = 0.5 / 3600.0 * 0.5 / 6.0;  // half an alarm an hour by six parts, stretches of 0.5 s

MahalanobisTail tail_of(const Squares& squares) {
  MahalanobisTail tail;
  for (const double square : squares.largest_of(1, many)) tail.add(std::sqrt(square), squares.drives);
  return tail;
}

TEST(TheVariation, IsThatWithWhichTheVarianceOfErrorsVaries) {
  for (const int drives : {2, 3, 6})
    for (const double variation : {0.0, 0.05, 0.2})
      EXPECT_NEAR(tail_of({drives, variation}).variation(), variation, 0.01) << drives;
  EXPECT_EQ(MahalanobisTail().variation(), 0.0);
  MahalanobisTail broken;
  broken.add(INFINITY, 3);
  EXPECT_EQ(broken.variation(), 0.0);
}

TEST(TheVariation, IsFoundFromNormalErrors) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> error;
  MahalanobisTail tail;
  for (int k = 0; k < 100'000; ++k) tail.add(std::hypot(error(random), error(random), error(random)), 3);
  EXPECT_NEAR(tail.variation(), 0.0, 0.02);
}

TEST(ThePower, IsTwoForNormalErrorsAndOneForThoseThatVary) {
  EXPECT_NEAR(tail_of({3, 0.0}).power(0.95), 2.0, 0.05);
  EXPECT_NEAR(tail_of({3, 0.1}).power(0.95), 1.5, 0.05);
  EXPECT_EQ(tail_of({3, 0.4}).power(0.95), 1.0);
}

/// How often stretches of so many independent samples exceed a threshold that was calibrated from 180 of
/// them, as a multiple of what was asked.
double rate_kept(const Squares& squares, int samples, double power) {
  std::vector<double> maxima = squares.largest_of(samples, many);
  for (double& maximum : maxima) maximum = std::pow(maximum, power / 2);
  const double threshold = upper_quantile_above(fit_gumbel(maxima), 180, asked, 0.95);
  return samples * squares.above(std::pow(threshold, 2 / power)) / asked;
}

TEST(ThePower, KeepsTheRateOfThresholdsHoweverErrorsVary) {
  for (const int drives : {2, 3, 6}) {
    for (const int samples : {50, 200}) {
      for (const double variation : {0.0, 0.025, 0.05, 0.1, 0.15, 0.2, 0.3}) {
        const Squares squares{drives, variation};
        const double kept = rate_kept(squares, samples, tail_of(squares).power(0.95));
        std::printf(
            "%d drives, %3d samples, variation %5.3f: %.2f of the rate asked; by power 1 %.2g, by 2 %.2g\n",
            drives, samples, variation, kept, rate_kept(squares, samples, 1.0),
            rate_kept(squares, samples, 2.0));
        EXPECT_LE(kept, 1.0);
        EXPECT_GE(kept, 0.05) << "and the threshold is not far too high";
      }
    }
  }
}

/// Robots whose errors are normal, each with a variance of its own, drawn with this relative variance.
class Robots {
 public:
  Robots(int count, const Squares& all, std::mt19937_64& random) : all_(all) {
    const double deviation = std::sqrt(std::log1p(all_.variation));
    std::normal_distribution<double> normal;
    for (int i = 0; i < count; ++i)
      variances_.push_back(std::exp(deviation * normal(random) - deviation * deviation / 2));
  }
  MahalanobisTail tail() const {
    static const std::vector<double> squares = Squares{3, 0.0}.largest_of(1, 1000);
    MahalanobisTail tail;
    for (const double variance : variances_) {
      tail.begin_robot();
      for (const double square : squares) tail.add(std::sqrt(variance * square), 3);
    }
    return tail;
  }
  /// How often stretches of other robots exceed a threshold that was calibrated from 180 of these, as a
  /// multiple of what was asked.
  double rate_of_others(double power) const {
    constexpr int samples = 100;
    static const std::vector<double> largest = Squares{3, 0.0}.largest_of(samples, 1000);
    std::vector<double> maxima;
    for (const double variance : variances_) {
      for (const double square : largest) maxima.push_back(std::pow(variance * square, power / 2));
    }
    const double threshold = upper_quantile_above(fit_gumbel(maxima), 180, asked, 0.95);
    return samples * all_.above(std::pow(threshold, 2 / power)) / asked;
  }

 private:
  Squares all_;
  std::vector<double> variances_;
};

TEST(TheVariation, TellsByHowMuchRobotsDiffer) {
  MahalanobisTail tail;
  for (const double variance : {0.8, 1.0, 1.2}) {
    tail.begin_robot();
    for (const double square : Squares{3, 0.0}.largest_of(1, many)) tail.add(std::sqrt(variance * square), 3);
  }
  EXPECT_NEAR(tail.between_robots(), 0.04, 1e-6);
  EXPECT_NEAR(tail.variation(), 0.04 * 2 / 3, 2e-3) << "of these three, not of those they were drawn from";
  EXPECT_EQ(tail_of({3, 0.1}).between_robots(), 0.0) << "of one";
  EXPECT_LT(tail.power(0.95), tail.power(0.5)) << "others may differ by more";
  EXPECT_NEAR(tail.power(0.5), 2.0 - 5.0 * 0.04 * 2 / 1.386, 0.05) << "the median of chi-square of 2 degrees";
}

TEST(ThePower, IsTheLeastWhereOneOfManyRobotsWasSeen) {
  const std::vector<double> normal = Squares{3, 0.0}.largest_of(1, many);
  const auto add = [&](MahalanobisTail& tail) {
    for (const double square : normal) tail.add(std::sqrt(square), 3);
  };
  MahalanobisTail one;
  one.begin_robot();
  add(one);
  EXPECT_EQ(one.power(0.95), 1.0);
  one.begin_robot();
  add(one);
  EXPECT_NEAR(one.power(0.95), 2.0, 0.05) << "two that do not differ at all";
}

TEST(ThePower, OfTwoRobotsFallsByHowLittleTheirDifferenceTells) {
  MahalanobisTail tail;
  for (const double variance : {0.99, 1.01}) {
    tail.begin_robot();
    for (const double square : Squares{3, 0.0}.largest_of(1, many)) tail.add(std::sqrt(variance * square), 3);
  }
  // Of one degree chi-square is the square of a normal variable: below 0.0025153 in 4 %, 0.0039321 in 5 %.
  EXPECT_NEAR(tail.power(0.96), 2.0 - 5.0 * 2e-4 / 0.0025153, 0.01);
  EXPECT_NEAR(tail.power(0.95), 2.0 - 5.0 * 2e-4 / 0.0039321, 0.01);
}

// Nine robots tell little of how much others differ, and their mean is not that of all.
TEST(ThePower, KeepsTheRateOfRobotsThatWereNotRecordedByFourOfFiveNines) {
  std::mt19937_64 random(1);
  for (const double variation : {0.02, 0.05, 0.1}) {
    int exceeded = 0, exceeded_as_pooled = 0;
    constexpr int draws = 200;
    for (int draw = 0; draw < draws; ++draw) {
      const Robots nine(9, {3, variation}, random);
      const MahalanobisTail tail = nine.tail();
      exceeded += nine.rate_of_others(tail.power(0.95)) > 1.0;
      exceeded_as_pooled += nine.rate_of_others(std::clamp(2.0 - 5.0 * tail.variation(), 1.0, 2.0)) > 1.0;
    }
    std::printf(
        "nine robots, variation %.2f: thresholds of %d of %d nines raise more than asked, %d by all alike\n",
        variation, exceeded, draws, exceeded_as_pooled);
    EXPECT_LE(exceeded, draws / 5);
    EXPECT_GT(2 * exceeded_as_pooled, 3 * exceeded);
  }
}

TEST(ThePower, IsNeededForNormalErrorsToHaveAThresholdThatIsNoHigherThanItMustBe) {
  EXPECT_LT(rate_kept({3, 0.0}, 200, 1.0), 0.01);
  EXPECT_GT(rate_kept({3, 0.2}, 200, 2.0), 5.0);
}

}  // namespace
}  // namespace flinch
