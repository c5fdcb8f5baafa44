#include "calibration/chi_square_quantile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flinch {
namespace {

struct Tabulated {
  int degrees;
  double at_5, at_50, at_95;  // percent
};

// Abramowitz and Stegun, table 26.8, and as every book has them since.
TEST(TheQuantileOfChiSquare, IsThatOfTheTables) {
  for (const auto& [degrees, at_5, at_50, at_95] : {Tabulated{1, 0.00393214, 0.454936, 3.84146},
                                                    {2, 0.102587, 1.38629, 5.99146},
                                                    {3, 0.351846, 2.36597, 7.81473},
                                                    {8, 2.73264, 7.34412, 15.5073},
                                                    {19, 10.1170, 18.3377, 30.1435},
                                                    {100, 77.9295, 99.3341, 124.342}}) {
    EXPECT_NEAR(chi_square_quantile(degrees, 0.05) / at_5, 1.0, 1e-5) << degrees;
    EXPECT_NEAR(chi_square_quantile(degrees, 0.5) / at_50, 1.0, 1e-5) << degrees;
    EXPECT_NEAR(chi_square_quantile(degrees, 0.95) / at_95, 1.0, 1e-5) << degrees;
  }
}

TEST(TheQuantileOfChiSquare, IsAboveZeroHoweverSmallTheProbability) {
  // Of one degree and small x the probability is sqrt(2 x / pi).
  EXPECT_NEAR(chi_square_quantile(1, 1e-4) / (std::acos(-1.0) / 2 * 1e-8), 1.0, 1e-6);
}

}  // namespace
}  // namespace flinch
