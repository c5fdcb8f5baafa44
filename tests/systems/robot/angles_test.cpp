#include "systems/robot/angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/framework/random.h"

namespace flinch {
namespace {

constexpr double pi = std::numbers::pi;

TEST(WrapAngle, IsTheRemainderToTheLastBit) {
  RandomGenerator random(1);
  for (int k = 0; k < 100000; ++k) {
    const double angle = random.uniform(-1.0, 1.0) * (k % 2 == 0 ? 3.0 * pi : 100.0);
    ASSERT_EQ(wrap_angle(angle), std::remainder(angle, 2.0 * pi)) << angle;
  }
}

TEST(WrapAngle, HasPiButNotMinusPi) {
  for (const double angle : {-3.0 * pi, -pi, pi, 3.0 * pi}) EXPECT_EQ(wrap_angle(angle), pi);
  EXPECT_LT(wrap_angle(std::nextafter(pi, 4.0)), 0.0);
  EXPECT_GT(wrap_angle(std::nextafter(-pi, -4.0)), 0.0);
  EXPECT_EQ(wrap_angle(0.0), 0.0);
}

}  // namespace
}  // namespace flinch
