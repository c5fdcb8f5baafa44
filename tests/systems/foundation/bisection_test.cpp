#include "systems/foundation/bisection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace flinch {
namespace {

TEST(Bisection, FindsARootToTheLastBit) {
  const double root = bisect([](double x) { return 2.0 - x * x; }, 1.0, 2.0);
  EXPECT_NEAR(root, std::sqrt(2.0), std::numeric_limits<double>::epsilon());
}

TEST(Bisection, FindsWhereASignJumps) {
  EXPECT_EQ(bisect([](double x) { return x < 0.375 ? 1.0 : -1.0; }, 0.0, 1.0), 0.375);
}

TEST(Bisection, EndsWhereThereIsNothingBetween) {
  const auto falling = [](double x) { return -x; };
  EXPECT_EQ(bisect(falling, 1.0, 1.0), 1.0);
  EXPECT_TRUE(std::isnan(bisect(falling, 0.0, std::nan(""))));
}

}  // namespace
}  // namespace flinch
