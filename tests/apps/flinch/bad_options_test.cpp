// Verbs with options that do not fit: as in bad_input_test.cpp.
#include <gmock/gmock.h>

#include "tests/apps/flinch/bad_input.h"

namespace flinch {
namespace {

using test::BadInput;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

TEST_F(BadInput, SpeedLimitsOfWhatCannotBeTried) {
  const auto complaint_about = [this](const std::vector<std::string>& options) {
    std::vector<std::string> call = {"speed-limit", place.at(collision), "--out", place.at("out")};
    call.insert(call.end(), options.begin(), options.end());
    return complaint(call);
  };
  for (const std::string at : {"here", "0.1", "0.1,nan", "0.1,0.2,0.3", "1e9,0"}) {
    EXPECT_EQ(complaint_about({"--at", at}),
              "error: --at " + at + ": is no place; give x and y in m, such as --at -0.04,0\n");
  }
  EXPECT_EQ(complaint_about({"--region", "hnad"}),
            "error: --region: is 'hnad', which is no region of the body that has limits; did you mean "
            "'hand'?\n");
  EXPECT_EQ(
      complaint_about({"--body", "arm"}),
      "error: --body arm: this robot has no such contact; it may be platform, link1, link2, clamping\n");
  EXPECT_THAT(complaint_about({"--runs", "28"}), HasSubstr("give 29 or more, or raise --share, or lower "));
  EXPECT_THAT(complaint_about({"--share", "nan"}), HasSubstr("it must be a number from 0.001 to 0.5"));
  EXPECT_THAT(complaint_about({"--grid", "200", "--directions", "360"}),
              MatchesRegex("error: --grid: asks for .* cells, .*; at most 100000 can be\n"));
  EXPECT_EQ(complaint_about({"--set", "pylon.radios_mm=30"}),
            "error: --set pylon.radios_mm=30: pylon.radios_mm: is not a known key; did you mean "
            "'radius_m'?\n");
  const std::string line = at_line_of(collision, "kind: passage");
  place.replace(collision, "kind: passage", "kind: hold # passage");
  EXPECT_THAT(complaint_about({}), StartsWith(line + "motion.kind: is 'hold'; it must be 'passage'"));
}

TEST_F(BadInput, ModelThatIsNoParallelRobot) {
  const auto convert = [&](const std::string& model, const std::vector<std::string>& more) {
    place.write("model.urdf", model);
    std::vector<std::string> call = {"convert", place.at("model.urdf"), "--out", place.at("robot.yaml")};
    call.insert(call.end(), more.begin(), more.end());
    return complaint(call);
  };
  const std::string error = "error: " + place.at("model.urdf");
  EXPECT_THAT(convert("kind: legs", {"--platform", "p"}), StartsWith(error + ":"));
  EXPECT_THAT(convert("<html/>", {"--platform", "p"}),
              StartsWith(error + ":1: <html> is no description of a robot"));
  EXPECT_THAT(convert("<robot name=\"r\"><link name=\"a\"/></robot>", {"--platform", "b"}),
              StartsWith(error + ": has no link or frame 'b'"));
  EXPECT_THAT(convert("<robot name=\"r\"><link name=\"a\"/></robot>", {"--platform", "a"}),
              StartsWith(error + ": closes no loop"));
  EXPECT_THAT(convert("<robot name=\"r\"><link name=\"a\"/></robot>", {"--platform", "a", "--guess", "j"}),
              StartsWith("error: --guess: is 'j'; it must be JOINT=NUMBER"));
}

}  // namespace
}  // namespace flinch
