#include "systems/robot/drive_parameters.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(Delay, IsSoManyWholeIntervalsAndARestOfOneAtMost) {
  for (const double delay : {-0.5e-3, 0.0, 0.1e-3, 0.25e-3, 0.6e-3, 1e-3}) {
    const auto [whole, rest] = in_intervals(delay, 0.25e-3);
    EXPECT_NEAR(static_cast<double>(whole) * 0.25e-3 + rest, delay, 1e-18);
    EXPECT_LE(rest, 0.25e-3 + 1e-12);
    EXPECT_LT(whole, most_delayed);
  }
}

TEST(Delay, OfOneIntervalIsLeftWhole) {
  EXPECT_EQ(in_intervals(1e-3, 1e-3).whole, 0u);
  EXPECT_EQ(in_intervals(1e-3, 1e-3).rest, 1e-3);
}

}  // namespace
}  // namespace flinch
