#include "systems/foundation/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace flinch {
namespace {

const std::vector<std::string> known = {"mass", "stiffness", "damping", "link1_length"};

TEST(NearestName, FindsWhatWasMeant) {
  EXPECT_EQ(nearest_name("mas", known), "mass");
  EXPECT_EQ(nearest_name("stifness", known), "stiffness");
  EXPECT_EQ(nearest_name("link_length", known), "link1_length");
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("zzzzzzzz", known), "");
  EXPECT_EQ(nearest_name("anything", {}), "");
}

TEST(DidYouMean, ListsAllNamesWhenNoneIsNear) {
  EXPECT_EQ(did_you_mean("dampin", known), "; did you mean 'damping'?");
  EXPECT_EQ(did_you_mean("qqqqqqqq", known), "; known are: mass, stiffness, damping, link1_length");
  EXPECT_EQ(listed(known), "mass, stiffness, damping, link1_length");
  EXPECT_EQ(known_names(known), "; known are: mass, stiffness, damping, link1_length");
  EXPECT_EQ(known_names({}), "");
}

}  // namespace
}  // namespace flinch
