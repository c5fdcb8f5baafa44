#include "experiments/robot_check/robot_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string text_of(const std::string& robot) {
  std::ifstream file(test::shipped("robots/" + robot));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Doubts about a shipped robot file in which the first `what` is replaced.
std::vector<std::string> warnings_with(const std::string& robot, const std::string& what,
                                       const std::string& by) {
  std::string text = text_of(robot);
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
  return robot_warnings(parse_robot_file(text, robot));
}

TEST(RobotWarnings, AreNoneAboutShippedRobots) {
  for (const auto& entry : std::filesystem::directory_iterator(test::shipped("robots")))
    EXPECT_THAT(robot_warnings(read_robot_file(entry.path())), IsEmpty()) << entry.path();
}

TEST(RobotWarnings, NameMassesInGrams) {
  EXPECT_THAT(warnings_with("delta.yaml", "platform: {mass_kg: 0.45", "platform: {mass_kg: 450"),
              Contains(HasSubstr("platform.mass is 450 kg, more than a ball of steel")));
  EXPECT_THAT(warnings_with("delta.yaml", "{mass_kg: 0.80", "{mass_kg: 800"),
              Contains(HasSubstr("drives.max_torque is 30 Nm, and a drive needs")));
}

TEST(RobotWarnings, NameTheInertiaOfAnotherBody) {
  EXPECT_THAT(
      warnings_with("delta.yaml", "inertia_kg_m2: [3.0e-4, 3.0e-4, 5.0e-4]", "inertia_kg_m2: [3, 3, 5]"),
      Contains(HasSubstr("platform.inertia and a mass of 0.45 kg are those of a body with a radius of "
                         "gyration of 3.33 m")));
}

TEST(RobotWarnings, NameCentresOfMassThatAreMetresAway) {
  EXPECT_THAT(
      warnings_with("delta.yaml", "centre_of_mass_m: [0.13, 0.0, 0.0]", "centre_of_mass_m: [130, 0, 0]"),
      Contains(HasSubstr("centre_of_mass lies 130 m away from the body's frame")));
}

TEST(RobotWarnings, NameAnglesOfMoreThanATurn) {
  EXPECT_THAT(warnings_with("delta.yaml", "range_deg: [-40.0, 95.0]", "range_deg: [-900, 95]"),
              Contains(HasSubstr("range is -15.708 rad (-900 deg), more than a turn")));
}

TEST(RobotWarnings, NameALegUnlikeTheOthers) {
  EXPECT_THAT(
      warnings_with("planar_3rrr.yaml", "base_parameters: *leg_inertia",
                    "base_parameters: {p1_kg_m2: 605.4, p2_kg_m2: 96.55, p3_kg_m2: 135.7}"),
      Contains(HasSubstr("legs[1].base_parameters.p1 is 605.4 kg m^2, of other legs 0.605363 kg m^2")));
}

}  // namespace
}  // namespace flinch
