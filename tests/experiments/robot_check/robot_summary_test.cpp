#include "experiments/robot_check/robot_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/robot_check/workspace_picture.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(RobotSummary, SaysHowTheRobotMovesWhatItReachesAndWhatIsDefault) {
  const std::string text = robot_summary_text(read_robot_file(test::shipped("robots/delta.yaml")));
  for (const char* const part :
       {"delta: 3 legs; 3 drives that turn", "moves in x, y, z; controlled every 1 ms",
        "(0, 0, -620) mm; condition number", "turned as at", "% of the poses in reach; beyond max_distance",
        "above 5 in", "by default a condition number of", "none on straight ways from home",
        "drives.max_speed"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(text, Not(HasSubstr("not told apart")));
}

TEST(RobotSummary, SaysWhichLinksCannotBeToldApart) {
  EXPECT_THAT(robot_summary_text(read_robot_file(test::shipped("robots/hexapod_6ups.yaml"))),
              HasSubstr("a touch of the one and of the other link of each leg"));
}

TEST(RobotSummary, IsTheSameInJson) {
  const nlohmann::ordered_json json = robot_summary_json(read_robot_file(test::shipped("robots/delta.yaml")));
  EXPECT_EQ(json.at("name"), "delta");
  EXPECT_EQ(json.at("reach_m").size(), 3U);
  EXPECT_LT(json.at("poses_within_limits"), json.at("poses"));
  EXPECT_EQ(json.at("poses_beyond").at("max_rotation"), 0);
  EXPECT_FALSE(json.at("defaults").empty());
}

TEST(WorkspacePicture, ShowsOneSectionInThePlaneAndTwoInSpace) {
  const auto platforms = [](const char* robot) {
    const std::string svg = workspace_picture(read_robot_file(test::shipped(robot)));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    int count = 0;
    for (std::size_t at = svg.find("<polygon"); at != std::string::npos; at = svg.find("<polygon", at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(platforms("robots/five_bar.yaml"), 1);
  EXPECT_EQ(platforms("robots/delta.yaml"), 2);
}

}  // namespace
}  // namespace flinch
