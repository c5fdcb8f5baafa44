#include "identification/clipped.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

Eigen::VectorXd wave(double limit) {
  Eigen::VectorXd x(1000);
  for (Eigen::Index k = 0; k < x.size(); ++k)
    x[k] = std::clamp(std::sin(0.05 * static_cast<double>(k)), -limit, limit);
  return x;
}

TEST(ClippedSamples, AreThoseAtTheLimitOnBothSides) {
  const Eigen::VectorXd x = wave(0.8);
  std::vector<char> usable(1000, 1);
  const std::size_t clipped = mark_clipped(x, usable);
  EXPECT_GT(clipped, 300U);
  EXPECT_EQ(clipped, static_cast<std::size_t>(std::count(usable.begin(), usable.end(), 0)));
  for (std::size_t k = 0; k < usable.size(); ++k)
    EXPECT_EQ(usable[k] == 0, std::abs(x[static_cast<Eigen::Index>(k)]) == 0.8) << k;
}

TEST(ClippedSamples, AreNoneOfASignalWithinItsRangeOrWithoutOne) {
  std::vector<char> usable(1000, 1);
  EXPECT_EQ(mark_clipped(wave(2.0), usable), 0U);
  EXPECT_EQ(mark_clipped(Eigen::VectorXd::Zero(1000), usable), 0U);
  EXPECT_EQ(mark_clipped(Eigen::VectorXd(), usable), 0U);
  EXPECT_EQ(std::count(usable.begin(), usable.end(), 0), 0);
}

TEST(WhatIsNotUsable, IsWidenedToBothSidesAndNotBeyondTheEnds) {
  std::vector<char> usable = {1, 1, 1, 1, 0, 1, 1, 1, 1, 0};
  widen_unusable(usable, 2);
  EXPECT_EQ(usable, (std::vector<char>{1, 1, 0, 0, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace flinch
