#include "systems/robot/body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace flinch {
namespace {

TEST(PairsOfDifferentLegs, AreAllButThoseOfOneLegAndOfThePlatform) {
  const std::vector<Body> bodies = {
      {"platform", -1, {}}, {"a1", 0, {}}, {"a2", 0, {}}, {"b1", 1, {}}, {"c1", 2, {}}};
  std::vector<std::pair<int, int>> pairs;
  for (const BodyPair& pair : pairs_of_different_legs(bodies)) pairs.emplace_back(pair.a, pair.b);
  EXPECT_THAT(pairs, testing::ElementsAre(std::pair(1, 3), std::pair(1, 4), std::pair(2, 3), std::pair(2, 4),
                                          std::pair(3, 4)));
}

}  // namespace
}  // namespace flinch
