#include "systems/config/legs_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "systems/config/robot_file.h"
#include "systems/robot/legs/legs_robot.h"
#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using test::problems_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::filesystem::path robots = std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots";

TEST(ShippedLegs, AreReadWithTheirCoordinatesDrivesAndForms) {
  struct Expected {
    const char* file;
    int dof, drives, legs, passive;
  };
  for (const Expected& each : {Expected{"delta.yaml", 3, 3, 3, 0},
                               {"planar_3rpr.yaml", 3, 3, 3, 0},
                               {"planar_4rrr.yaml", 3, 4, 4, 4},
                               {"hexa_6rus.yaml", 6, 6, 6, 0},
                               {"linapod_6pus.yaml", 6, 6, 6, 0},
                               {"tricept.yaml", 3, 3, 4, 0}}) {
    const RobotFile file = read_robot_file(robots / each.file);
    EXPECT_EQ(file.robot->dof(), each.dof) << each.file;
    EXPECT_EQ(file.robot->drives(), each.drives) << each.file;
    EXPECT_EQ(file.robot->legs(), each.legs) << each.file;
    EXPECT_EQ(file.robot->passive_joints(), each.passive) << each.file;
    EXPECT_EQ(file.drives.torque_constant.size(), each.drives) << each.file;
    const auto& robot = dynamic_cast<const LegsRobot&>(*file.robot);
    const bool in_closed_form = robot.model().following() == 0;
    for (const ModelLeg& leg : robot.model().legs) {
      EXPECT_EQ(leg.form.has_value(), in_closed_form) << each.file;
    }
  }
}

// The shoulders of the 6-RUS turn from -50 to 85 degrees; the linapod has limits of its own.
TEST(ShippedLegs, KeepTheirDrivesWithinTheRangesOfTheirJoints) {
  const WorkspaceLimits hexa = read_robot_file(robots / "hexa_6rus.yaml").limits;
  EXPECT_NEAR(hexa.min_active, -50.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_NEAR(hexa.max_active, 85.0 * std::numbers::pi / 180.0, 1e-12);
  const WorkspaceLimits linapod = read_robot_file(robots / "linapod_6pus.yaml").limits;
  EXPECT_EQ(linapod.min_active, 0.45);
  EXPECT_EQ(linapod.max_active, 1.05);
}

class LegsFile : public ::testing::Test {
 protected:
  void replace(const std::string& from, const std::string& to) {
    const std::size_t at = text_.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text_.replace(at, from.size(), to);
  }
  std::vector<std::string> problems() const {
    return problems_of([this] { parse_robot_file(text_, "robot.yaml"); });
  }
  void expect_problem(const std::string& sentence) const {
    EXPECT_THAT(problems(), Contains(HasSubstr(sentence)));
  }

  // A planar 3-RPR: legs at the corners of a triangle, the platform's joints at those of a turned smaller
  // one.
  std::string text_ = R"(kind: legs
moves: planar_pose
home_pose: {x_m: 0, y_m: 0}
characteristic_length_m: 0.1
platform: {mass_kg: 1.2, inertia_kg_m2: [0.01, 0.01, 0.012]}
legs:
  - at_m: [0, 0.5, 0]
    turned_deg: [0, 0, -90]
    joints:
      - {name: foot, kind: revolute, link: {mass_kg: 1.5}}
      - {name: slide, kind: prismatic, axis: [1, 0, 0], drive: {}, reference_m: 0.4}
    closures: [{on_platform_m: [-0.0564642, 0.0825336, 0]}]
  - at_m: [-0.4330127, -0.25, 0]
    turned_deg: [0, 0, 30]
    joints: &joints
      - {name: foot, kind: revolute, link: {mass_kg: 1.5}}
      - {name: slide, kind: prismatic, axis: [1, 0, 0], drive: {}, reference_m: 0.4}
    closures: [{on_platform_m: [-0.0432441, -0.0901661, 0]}]
  - {at_m: [0.4330127, -0.25, 0], turned_deg: [0, 0, 150], joints: *joints,
     closures: [{on_platform_m: [0.0997085, 0.0076325, 0]}]}
)";
};

TEST_F(LegsFile, ThatIsGoodHasNoProblem) {
  replace("drive: {}", "drive: {ratio: 1}");
  while (text_.find("drive: {}") != std::string::npos) replace("drive: {}", "drive: {ratio: 1}");
  EXPECT_EQ(parse_robot_file(text_, "robot.yaml").robot->drives(), 3);
}

TEST_F(LegsFile, TellsFileLineAndKey) {
  replace("kind: revolute, link", "kind: revolut, link");
  EXPECT_THAT(problems(), Contains(HasSubstr("robot.yaml:10: legs[0].joints[0].kind")));
}

TEST_F(LegsFile, NamesAJointTwice) {
  replace("name: slide", "name: foot");
  expect_problem("legs[0].joints[1].name: 'foot' is that of another joint of the leg");
}

TEST_F(LegsFile, NamesAJointThatIsNot) {
  replace("{name: slide,", "{name: slide, on: food,");
  expect_problem("legs[0].joints[1].on: is 'food', which is no joint of the leg; those before are 'foot'");
}

TEST_F(LegsFile, FollowsAJointThatComesLater) {
  replace("kind: revolute, link", "kind: revolute, follows: {joint: slide}, link");
  expect_problem("legs[0].joints[0].follows.joint: is 'slide', which comes later");
}

TEST_F(LegsFile, HasAnAxisOfNoLength) {
  replace("axis: [1, 0, 0]", "axis: [0, 0, 0]");
  expect_problem("legs[0].joints[1].axis: has no length");
}

TEST_F(LegsFile, LeavesThePlane) {
  replace("axis: [1, 0, 0]", "axis: [1, 0, 1]");
  expect_problem("legs[0].joints[1]: leaves the plane z = 0");
}

TEST_F(LegsFile, HasAUniversalJointWhoseAxesAreNotAcross) {
  replace("moves: planar_pose", "moves: spatial_pose");
  replace("kind: revolute, link", "kind: universal, axis: [0, 0, 1], second_axis: [0, 1, 1], link");
  expect_problem("legs[0].joints[0].second_axis: is not across the first");
}

TEST_F(LegsFile, HasAnInertiaOfNoBody) {
  replace("inertia_kg_m2: [0.01, 0.01, 0.012]", "inertia_kg_m2: [0.01, 0.01, 0.03]");
  expect_problem("platform.inertia_kg_m2: has the principal moments 0.01 0.01 0.03 kg m^2");
}

TEST_F(LegsFile, HasALegThatHoldsNothing) {
  replace("closures: [{on_platform_m: [-0.0564642, 0.0825336, 0]}]", "closures: [{on_base_m: [0, 0.1, 0]}]");
  expect_problem("legs[0].closures: hold nothing of the platform");
}

TEST_F(LegsFile, HasTooFewDrives) {
  replace("drive: {}, ", "");
  expect_problem("legs: has 2 drives for 3 coordinates");
}

TEST_F(LegsFile, HasALegThatDoesNotReachHome) {
  replace("reference_m: 0.4", "range_m: [0.1, 0.3], reference_m: 0.4");
  expect_problem("legs[0]: does not reach home_pose: a joint would stand at 0.42");
}

TEST_F(LegsFile, HasALegThatCanMoveByItself) {
  replace("      - {name: slide", "      - {name: spare, kind: revolute}\n      - {name: slide");
  expect_problem("legs[0]: can move while the platform stands still");
}

TEST_F(LegsFile, HasAPlatformThatAnotherClosureHolds) {
  replace("closures: [{on_platform_m: [-0.0564642, 0.0825336, 0]}]",
          "closures: [{on_platform_m: [-0.0564642, 0.0825336, 0]}, {at_m: [0.1, 0, 0], on_platform_m: "
          "[-0.0564642, -0.0174664, 0]}]");
  EXPECT_THAT(problems(),
              Contains(::testing::AnyOf(HasSubstr("the platform cannot move as `moves` says"),
                                        HasSubstr("does not reach home_pose: its closure stays open"))));
}

TEST_F(LegsFile, IsSingularAtHome) {
  // All legs run through the middle of the platform, which they do not keep from turning.
  replace("[-0.0564642, 0.0825336, 0]", "[0, 0.1, 0]");
  replace("[-0.0432441, -0.0901661, 0]", "[-0.0866025403784, -0.05, 0]");
  replace("[0.0997085, 0.0076325, 0]", "[0.0866025403784, -0.05, 0]");
  expect_problem("home_pose: is singular: the drives do not hold rz");
}

TEST_F(LegsFile, HasLinksWithShapesThatNoContactKnows) {
  replace("link: {mass_kg: 1.5}",
          "link: {mass_kg: 1.5, shapes: [{sphere: {radius_m: 0.1}}, {blob: {radius_m: 1}}]}");
  EXPECT_FALSE(problems().empty());
}

TEST_F(LegsFile, FreesCoordinatesThatNoSpaceHas) {
  replace("moves: planar_pose", "moves: coordinates\ncoordinates: {z: free, rx: free, ry: free}");
  expect_problem("coordinates: frees coordinates that no robot can have yet");
}

TEST_F(LegsFile, SumsJointsThatAreNone) {
  while (text_.find("drive: {}, ") != std::string::npos) replace("drive: {}, ", "");
  text_ += "drive_map: [{leg1.slide: 1.0}, {leg4.slide: 1.0}, {leg3.slid: 1.0}]\n";
  expect_problem("drive_map[1].leg4.slide: is no joint; it is named as in leg1.foot");
  expect_problem("drive_map[2].leg3.slid: is no joint");
}

TEST_F(LegsFile, IsReadAgainWithoutTheLimitsOfARobotThatIsNone) {
  replace("characteristic_length_m: 0.1", "characteristic_length_m: -0.1");
  text_ += "workspace_limits: {min_active_length_m: 0.3}\n";
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("characteristic_length")));
}

}  // namespace
}  // namespace flinch
