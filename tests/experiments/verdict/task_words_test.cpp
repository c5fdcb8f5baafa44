#include "experiments/verdict/task_words.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace flinch {
namespace {

TEST(TheWordsOfATask, TellEveryTaskOfEveryLegApart) {
  std::set<std::string> told;
  for (const FollowedTask& task : followed_tasks(6)) told.insert(in_words(task));
  EXPECT_EQ(told.size(), 3U + 3U * 6U);
}

TEST(TheWordsOfATask, CountLegsFromOne) {
  EXPECT_EQ(in_words({true, ReactionKind::opening, 1}), "opens leg 2");
  EXPECT_STREQ(word(ReactionKind::opening), "opening");
}

TEST(TheWordsOfATask, AreUnknownForANumberThatNoTaskHas) {
  EXPECT_STREQ(word(static_cast<ReactionKind>(200)), "unknown");
  EXPECT_EQ(in_words({true, static_cast<ReactionKind>(200), 0}), "does what is not known");
  EXPECT_EQ(in_words({true, ReactionKind::opening, std::numeric_limits<int>::max()}), "opens leg 2147483648");
}

}  // namespace
}  // namespace flinch
