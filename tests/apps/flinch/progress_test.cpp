#include "apps/flinch/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(TheTimeLeft, IsThatOfTheRestAtThePaceSoFar) {
  EXPECT_EQ(time_left(10.0, 0.25), "30.0 s left");
  EXPECT_EQ(time_left(600.0, 0.25), "30 min left");
  EXPECT_EQ(time_left(3600.0, 0.25), "3 h 00 min left");
  EXPECT_EQ(time_left(7500.0, 0.5), "2 h 05 min left");
}

TEST(TheTimeLeft, LeavesOutWhatWasDoneBefore) {
  EXPECT_EQ(time_left(10.0, 0.95, 0.90), "10.0 s left") << "not half a second";
  EXPECT_EQ(time_left(10.0, 0.90, 0.90), "");
}

TEST(TheTimeLeft, IsNotToldBeforeOneCanKnowNorAtTheEnd) {
  EXPECT_EQ(time_left(10.0, 0.0), "");
  EXPECT_EQ(time_left(10.0, 0.005), "");
  EXPECT_EQ(time_left(10.0, 1.0), "");
  EXPECT_EQ(time_left(10.0, 1.0, 1.0), "");
}

TEST(AProgressWithoutATerminal, TellsTheTimeLeftAtEveryQuarter) {
  testing::internal::CaptureStderr();
  {
    Progress progress("counting", false);
    for (int k = 1; k <= 8; ++k) progress.show(k / 8.0);
  }
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::MatchesRegex("counting: 25 %, [0-9.]+ s left\ncounting: 50 %, [0-9.]+ s left\n"
                                    "counting: 75 %, [0-9.]+ s left\ncounting: 100 %\n"));
}

}  // namespace
}  // namespace flinch
