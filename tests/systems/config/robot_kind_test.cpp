#include "systems/config/robot_kind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;

std::shared_ptr<const ParallelRobot> nothing(ConfigReader& /*file*/) { return nullptr; }

TEST(RobotKinds, AreThoseOfTheLibraryEachWithARobotThatServes) {
  std::vector<std::string> names;
  for (const RobotKind& kind : robot_kinds()) {
    names.push_back(kind.name);
    if (kind.name == "legs") continue;  // Its robots differ.
    ASSERT_TRUE(kind.preset);
    EXPECT_GT(kind.preset->drives(), 0);
  }
  EXPECT_THAT(names, ElementsAre("planar_3rrr", "five_bar", "hexapod_6ups", "legs"));
}

TEST(RobotKinds, AreNotAddedTwice) {
  const auto& preset = robot_kinds().front().preset;
  EXPECT_THAT(test::problems_of([&] {
                add_robot_kind({"five_bar", nothing, preset});
              }),
              ElementsAre("robot kind 'five_bar': there is one already"));
}

TEST(RobotKinds, NeedANameAReaderAndAPreset) {
  EXPECT_THAT(test::problems_of([] { add_robot_kind({}); }),
              ElementsAre("robot kind '': it needs a name, which files give at 'kind'",
                          "robot kind '': it needs a function that reads its keys",
                          "robot kind '': it needs a preset"));
}

}  // namespace
}  // namespace flinch
