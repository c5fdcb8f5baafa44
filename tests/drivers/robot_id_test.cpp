#include "drivers/robot_id.h"

#include <gmock/gmock.h>

namespace flinch {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

TEST(RobotId, IsNeverZeroAndNeverTheSameAlsoOfOneName) {
  EXPECT_NE(draw_robot_id(), 0u);
  EXPECT_NE(draw_robot_id(), draw_robot_id());
  EXPECT_NE(draw_robot_id("left"), draw_robot_id("left"));
}

TEST(RobotId, IsMeantByTheNameFromWhichItWasDrawnAndByItself) {
  const std::uint64_t left = draw_robot_id("left"), unnamed = draw_robot_id();
  EXPECT_TRUE(is_meant("left", left));
  EXPECT_FALSE(is_meant("right", left));
  EXPECT_FALSE(is_meant("left", unnamed));
  EXPECT_TRUE(is_meant(robot_id_text(left), left));
  EXPECT_TRUE(is_meant(robot_id_text(unnamed), unnamed));
  EXPECT_FALSE(is_meant(robot_id_text(left), draw_robot_id("left")));
}

TEST(RobotId, IsWrittenWithAllItsDigits) {
  EXPECT_EQ(robot_id_text(0x1f), "000000000000001f");
  EXPECT_EQ(robot_id_text(0xfedcba9876543210), "fedcba9876543210");
  EXPECT_TRUE(is_robot_id("fedcba9876543210"));
  EXPECT_FALSE(is_robot_id("fedcba987654321"));
  EXPECT_FALSE(is_robot_id("fedcba987654321g"));
}

TEST(RobotId, IsToldWithTheNameWhereThereIsOne) {
  EXPECT_EQ(text_of(std::vector<SeenRobot>{{1, "left"}, {2, ""}}),
            "left (0000000000000001), 0000000000000002");
}

TEST(RobotName, MayNotPassForAnIdentityNorPutOtherLettersOnATerminal) {
  EXPECT_THAT(problems_of_robot_name(""), IsEmpty());
  EXPECT_THAT(problems_of_robot_name("Left_arm-2.b"), IsEmpty());
  EXPECT_THAT(problems_of_robot_name(std::string(32, 'x')), IsEmpty());
  EXPECT_THAT(problems_of_robot_name(std::string(33, 'x')), SizeIs(1));
  EXPECT_THAT(problems_of_robot_name("fedcba9876543210"), SizeIs(1));
  for (const char* const name : {"left arm", "a\x1b[2J", "\xc3\xa4", "a\n"}) {
    EXPECT_THAT(problems_of_robot_name(name), SizeIs(1)) << name;
  }
}

}  // namespace
}  // namespace flinch
