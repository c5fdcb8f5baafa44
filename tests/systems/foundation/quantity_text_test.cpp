#include "systems/foundation/quantity_text.h"

#include <gtest/gtest.h>

#include <numbers>

namespace flinch {
namespace {

TEST(QuantityText, HasTheUnitBehindTheValue) {
  EXPECT_EQ(quantity_text(0.3, "m"), "0.3 m");
  EXPECT_EQ(quantity_text(-2.0, ""), "-2");
  EXPECT_EQ(quantity_text(0.5, "rad/s"), "0.5 rad/s");
}

TEST(QuantityText, TellsAnglesInDegreesBesides) {
  EXPECT_EQ(quantity_text(0.5 * std::numbers::pi, "rad"), "1.5708 rad (90 deg)");
}

}  // namespace
}  // namespace flinch
