#include "systems/contact/normal_share.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

double complementary(double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); }

TEST(NormalShare, IsThatOfTheErrorFunction) {
  for (double x = -7.0; x <= 9.0; x += 0.01) {
    EXPECT_NEAR(normal_share(x) / complementary(-x), 1.0, 4e-9) << x;
    const double tail = std::exp(0.5 * x * x) * complementary(std::abs(x));
    if (std::abs(x) < 7.0) {
      EXPECT_NEAR(normal_tail(std::abs(x)) / tail, 1.0, 4e-9) << x;
    }
  }
  EXPECT_EQ(normal_share(-8.0), 0.0);
}

// d/dx E[max(x - w, 0)] is the share of w below x.
TEST(NormalShare, IsTheSlopeOfTheExcess) {
  constexpr double step = 1e-4;
  for (double x = -6.0; x <= 8.0; x += 0.1) {
    const double slope = (normal_excess(x + step) - normal_excess(x - step)) / (2.0 * step);
    EXPECT_NEAR(slope, complementary(-x), 1e-8) << x;
  }
  EXPECT_NEAR(normal_excess(0.0), 1.0 / std::sqrt(2.0 * std::numbers::pi), 1e-15);
  EXPECT_NEAR(normal_excess(20.0), 20.0, 1e-15);
}

}  // namespace
}  // namespace flinch
