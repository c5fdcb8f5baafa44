#include "systems/foundation/setup_error.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(SetupError, SaysEveryProblemOnALineOfItsOwn) {
  const SetupError error(std::vector<std::string>{"first", "second"});
  EXPECT_STREQ(error.what(), "first\nsecond");
  EXPECT_EQ(error.problems().size(), 2U);
}

TEST(ThrowIfAny, ThrowsOnlyWhenThereAreProblems) {
  EXPECT_NO_THROW(throw_if_any({}));
  EXPECT_THROW(throw_if_any({"one"}), SetupError);
}

}  // namespace
}  // namespace flinch
