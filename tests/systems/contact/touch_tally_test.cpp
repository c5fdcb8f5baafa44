#include "systems/contact/touch_tally.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace flinch {
namespace {

/// The logarithm of exp(x^2 / 2) times the share of a normal distribution below x, by the error function.
double logarithm_of(double x) { return 0.5 * x * x + std::log(0.5 * std::erfc(-x / std::sqrt(2.0))); }

TEST(TouchTally, SumsLikelihoodsOfAnySize) {
  for (const double top : {0.5, 3.0, 6.0, 20.0, 60.0}) {
    TouchTally tally;
    long double sum = 0.0L;
    for (const double x : {-2.0, 0.2 * top, top, 0.9 * top, 0.0}) {
      if (x > 0.0) tally.make_room(0.5 * x * x);
      tally.add(0.3 * tally.likelihood(x), 0.0, 0.0, 0.0);
      sum += 0.3L * std::exp(static_cast<long double>(logarithm_of(x)));
    }
    EXPECT_NEAR(tally.unit + std::log(tally.sum), static_cast<double>(std::log(sum)), 1e-7) << top;
    EXPECT_LT(tally.sum, 1e6);
  }
}

TEST(TouchTally, KeepsWhatItsLargestTermIsAbout) {
  TouchTally tally;
  for (const double x : {1.0, 30.0, 12.0}) {
    tally.make_room(0.5 * x * x);
    tally.add(tally.likelihood(x), 0.1 * x, x, -x);
  }
  EXPECT_EQ(tally.location, 3.0);
  EXPECT_EQ(tally.force, 30.0);
  EXPECT_EQ(tally.approach, -30.0);
  EXPECT_NEAR(tally.top, 0.5 * 30.0 * 30.0, 1e-9);
  EXPECT_TRUE(tally.is_negligible(0.5 * 30.0 * 30.0 - 19.0));
  EXPECT_FALSE(tally.is_negligible(0.5 * 30.0 * 30.0 - 17.0));
}

}  // namespace
}  // namespace flinch
