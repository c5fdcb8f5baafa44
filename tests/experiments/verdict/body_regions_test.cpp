#include "experiments/verdict/body_regions.h"

#include <gtest/gtest.h>

#include <set>

namespace flinch {
namespace {

TEST(BodyRegions, HaveNamesOfTheirOwnAndASourceForEachNumber) {
  std::set<std::string_view> names;
  for (const BodyRegion& region : body_regions()) {
    EXPECT_TRUE(names.insert(region.name).second) << region.name;
    EXPECT_FALSE(region.title.empty());
    EXPECT_FALSE(region.quasi_static.source.empty()) << region.name;
    EXPECT_FALSE(region.transient.source.empty()) << region.name;
  }
}

// Where the standard permits a transient contact, it permits twice the quasi-static force.
TEST(BodyRegions, PermitNoMoreThanTwiceForAWhile) {
  for (const BodyRegion& region : body_regions()) {
    EXPECT_GT(region.quasi_static.force, 0.0);
    EXPECT_GE(region.transient.force, region.quasi_static.force) << region.name;
    EXPECT_LE(region.transient.force, 2.0 * region.quasi_static.force) << region.name;
  }
}

TEST(BodyRegions, OfHandAndArmAreWhatThePapersQuote) {
  const ForceLimits hand = force_limits_of(*find_body_region("hand"));
  EXPECT_EQ(hand.transient, 280.0);
  EXPECT_EQ(hand.quasi_static, 140.0);
  EXPECT_EQ(hand.transient_duration, 0.5);
  const ForceLimits arm = force_limits_of(*find_body_region("lower_arm"));
  EXPECT_EQ(arm.transient, 320.0);
  EXPECT_EQ(arm.quasi_static, 160.0);
  EXPECT_EQ(arm.region, "lower_arm");
}

TEST(BodyRegions, TheHandIsTheDefault) {
  const ForceLimits standard;
  EXPECT_EQ(standard.region, "hand");
  EXPECT_EQ(standard.transient, find_body_region("hand")->transient.force);
}

TEST(BodyRegions, OthersThereAreNot) { EXPECT_EQ(find_body_region("tail"), nullptr); }

}  // namespace
}  // namespace flinch
