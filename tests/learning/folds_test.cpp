#include "learning/folds.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "systems/framework/random.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

TEST(FoldsOfGroups, KeepEachGroupInOneFoldAndDealThemOutEvenly) {
  RandomGenerator random(1);
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    std::vector<int> groups;
    for (int i = 0; i < 300; ++i) groups.push_back(static_cast<int>(random() % 40) - 7);
    const int folds = 2 + static_cast<int>(random() % 9);
    const std::vector<int> fold = folds_of_groups(groups, folds, trial, "runs");
    ASSERT_EQ(fold.size(), groups.size());
    std::map<int, std::set<int>> folds_of_group, groups_in_fold;
    for (std::size_t i = 0; i < fold.size(); ++i) {
      ASSERT_TRUE(fold[i] >= 0 && fold[i] < folds);
      folds_of_group[groups[i]].insert(fold[i]);
      groups_in_fold[fold[i]].insert(groups[i]);
    }
    for (const auto& [group, in] : folds_of_group) EXPECT_EQ(in.size(), 1U) << group;
    ASSERT_EQ(groups_in_fold.size(), static_cast<std::size_t>(folds));
    const auto [fewest, most] =
        std::minmax_element(groups_in_fold.begin(), groups_in_fold.end(),
                            [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    EXPECT_LE(most->second.size() - fewest->second.size(), 1U);
  }
}

TEST(FoldsOfGroups, FollowFromTheSeed) {
  std::vector<int> groups(50);
  for (int i = 0; i < 50; ++i) groups[static_cast<std::size_t>(i)] = i;
  EXPECT_EQ(folds_of_groups(groups, 5, 3, "runs"), folds_of_groups(groups, 5, 3, "runs"));
  EXPECT_NE(folds_of_groups(groups, 5, 3, "runs"), folds_of_groups(groups, 5, 4, "runs"));
}

TEST(FoldsOfGroups, NeedAsManyGroups) {
  EXPECT_THAT(
      test::problems_of([] {
        folds_of_groups({4, 4, 9}, 3, 1, "configurations");
      }),
      testing::ElementsAre("there are 2 configurations to learn from; 3 folds need at least as many"));
}

}  // namespace
}  // namespace flinch
