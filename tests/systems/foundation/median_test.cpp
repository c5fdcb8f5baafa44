#include "systems/foundation/median.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flinch {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({5.0, 1.0, 3.0, 4.0}), 3.5);
}

TEST(Median, IsNoNumberWhereThereAreNone) { EXPECT_TRUE(std::isnan(median({}))); }

}  // namespace
}  // namespace flinch
