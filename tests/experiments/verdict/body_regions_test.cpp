#include "experiments/verdict/body_regions.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

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

TEST(BodyRegions, HandTheirSourcesOn) {
  EXPECT_EQ(ForceLimits().transient_source, find_body_region("hand")->transient.source);
  EXPECT_EQ(ForceLimits().quasi_static_source, find_body_region("hand")->quasi_static.source);
  const ForceLimits leg = force_limits_of(*find_body_region("lower_leg"));
  EXPECT_EQ(leg.transient_source, find_body_region("lower_leg")->transient.source);
  EXPECT_EQ(leg.quasi_static_source, find_body_region("lower_leg")->quasi_static.source);
  EXPECT_EQ(region_of(leg), "lower leg");
  EXPECT_EQ(region_of({.region = "tail"}), "tail");
}

TEST(BodyRegions, StandInTheDocumentOfTheFiles) {
  std::ifstream file(FLINCH_SOURCE_DIR "/docs/files.md");
  const std::string document(std::istreambuf_iterator<char>(file), {});
  for (const BodyRegion& region : body_regions()) {
    EXPECT_THAT(document, ::testing::HasSubstr(
                              fmt::format("\n| `{}` | {} | {:.0f} | {} | {:.0f} | {} |\n", region.name,
                                          region.title, region.quasi_static.force, region.quasi_static.source,
                                          region.transient.force, region.transient.source)));
  }
}

TEST(BodyRegions, OthersThereAreNot) { EXPECT_EQ(find_body_region("tail"), nullptr); }

}  // namespace
}  // namespace flinch
