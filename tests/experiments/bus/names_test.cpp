#include "experiments/bus/names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace flinch {
namespace {

TEST(Names, TellEveryStateApart) {
  std::set<std::string> states, modes;
  for (int state = 0; state < drive_state_count; ++state) states.insert(name(static_cast<DriveState>(state)));
  for (const ReactionMode mode : {ReactionMode::stopped, ReactionMode::nominal, ReactionMode::react,
                                  ReactionMode::hold, ReactionMode::zero_g}) {
    modes.insert(name(mode));
  }
  EXPECT_EQ(states.size(), static_cast<std::size_t>(drive_state_count));
  EXPECT_EQ(modes.size(), 5U);
  EXPECT_STREQ(name(ReactionMode::zero_g), "zero-g");
  EXPECT_STREQ(name(DriveState::fault), "fault");
}

TEST(Names, AreUnknownForANumberThatNamesNothing) {
  EXPECT_STREQ(name(static_cast<DriveState>(99)), "unknown");
  EXPECT_STREQ(name(static_cast<ReactionMode>(99)), "unknown");
}

}  // namespace
}  // namespace flinch
