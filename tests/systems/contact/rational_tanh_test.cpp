#include "systems/contact/rational_tanh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace flinch {
namespace {

TEST(RationalTanh, IsThatOfTheLibrary) {
  double worst = 0.0;
  for (int i = -400'000; i <= 400'000; ++i) {
    const double x = 1e-4 * i;
    worst = std::max(worst, std::abs(rational_tanh(x) - std::tanh(x)));
  }
  EXPECT_LT(worst, 6e-11);
  for (const double small : {1e-300, 1e-12, 1e-6, 1e-3}) {
    EXPECT_NEAR(rational_tanh(small) / std::tanh(small), 1.0, 1e-15);
    EXPECT_EQ(rational_tanh(-small), -rational_tanh(small));
  }
}

TEST(RationalTanh, NeverLeavesItsRangeNorHidesThatANumberIsNone) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double large : {12.0, 12.5, 13.0, 1e10, 1e300, infinity}) {
    EXPECT_LE(rational_tanh(large), 1.0);
    EXPECT_NEAR(rational_tanh(large), 1.0, 8e-11);
    EXPECT_EQ(rational_tanh(-large), -rational_tanh(large));
  }
  EXPECT_TRUE(std::isnan(rational_tanh(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace flinch
