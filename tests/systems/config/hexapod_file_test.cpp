#include "systems/config/hexapod_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>

#include "systems/config/robot_file.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/support/file_bytes.h"
#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using test::problems_of;
using ::testing::Contains;
using ::testing::ElementsAre;

const std::filesystem::path shipped =
    std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots/hexapod_6ups.yaml";

void expect_same_friction(const JointFriction& a, const JointFriction& b) {
  EXPECT_EQ(a.viscous, b.viscous);
  EXPECT_EQ(a.coulomb, b.coulomb);
}

HexapodParameters parameters_of(const RobotFile& file) {
  return std::dynamic_pointer_cast<const Hexapod>(file.robot)->parameters();
}

void expect_same_body(const RigidBodyInertia& a, const RigidBodyInertia& b) {
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.centre_of_mass, b.centre_of_mass);
  EXPECT_EQ(a.inertia, b.inertia);
}

TEST(HexapodFile, OfTheShippedRobotIsThePresetToANanometre) {
  const HexapodParameters a = parameters_of(read_robot_file(shipped));
  const HexapodParameters b = hexapod_robot(HexapodPayload::none, HexapodFriction::ball_screws);
  EXPECT_EQ(a.name, b.name);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT((a.legs[i].base_joint - b.legs[i].base_joint).norm(), 1e-9);
    EXPECT_LT((a.legs[i].platform_joint - b.legs[i].platform_joint).norm(), 1e-9);
    EXPECT_LT((a.legs[i].universal_axis - b.legs[i].universal_axis).norm(), 1e-9);
    expect_same_friction(a.legs[i].drive_friction, b.legs[i].drive_friction);
    expect_same_friction(a.legs[i].universal_friction, b.legs[i].universal_friction);
  }
  EXPECT_EQ(a.cylinder_length, b.cylinder_length);
  EXPECT_EQ(a.rod_length, b.rod_length);
  EXPECT_EQ(a.cylinder_radius, b.cylinder_radius);
  EXPECT_EQ(a.rod_radius, b.rod_radius);
  expect_same_body(a.cylinder, b.cylinder);
  expect_same_body(a.rod, b.rod);
  expect_same_body(a.platform, b.platform);
  EXPECT_FALSE(a.payload.has_value());
  EXPECT_EQ(a.drive_armature, b.drive_armature);
  EXPECT_EQ(a.drive_friction_velocity, b.drive_friction_velocity);
  EXPECT_EQ(a.universal_friction_velocity, b.universal_friction_velocity);
  EXPECT_EQ(a.platform_radius, b.platform_radius);
  EXPECT_EQ(a.platform_bottom, b.platform_bottom);
  EXPECT_EQ(a.platform_top, b.platform_top);
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.home_position, b.home_position);
  EXPECT_EQ(a.home_rotation, b.home_rotation);
  EXPECT_EQ(a.characteristic_length, b.characteristic_length);
}

TEST(HexapodFile, MayTellOfAPayload) {
  const std::string text = test::bytes_of(shipped) +
                           "payload: {mass_kg: 5.0, centre_of_mass_m: [0.03, -0.02, 0.08],\n"
                           "          inertia_kg_m2: [0.025, 0.030, 0.020]}\n";
  const RobotFile file = parse_robot_file(text, "hexapod.yaml");
  const HexapodParameters found = parameters_of(file);
  ASSERT_TRUE(found.payload.has_value());
  expect_same_body(*found.payload, *hexapod_robot(HexapodPayload::eccentric).payload);
}

// The shipped hexapod with `old` replaced.
std::string hexapod_with(const std::string& old, const std::string& text) {
  std::string file = test::bytes_of(shipped);
  return file.replace(file.find(old), old.size(), text);
}

TEST(HexapodFile, MayTellOfALegWithFrictionOfItsOwn) {
  const std::string axis = "universal_axis: [0.207911691, 0.978147601, 0.0]";  // of the sixth leg
  const std::string text = hexapod_with(axis, axis + "\n    drive_friction: {coulomb_N: 17.0}");
  const RobotFile file = parse_robot_file(text, "hexapod.yaml");
  const auto legs = parameters_of(file).legs;
  expect_same_friction(legs[0].drive_friction, {.viscous = 200.0, .coulomb = 15.0});
  expect_same_friction(legs[5].drive_friction, {.viscous = 0.0, .coulomb = 17.0});
  expect_same_friction(legs[5].universal_friction, {.viscous = 0.05, .coulomb = 0.0});
}

TEST(HexapodFile, TellsOnceOfFrictionThatDrivesInAllLegs) {
  EXPECT_THAT(problems_of([&] { parse_robot_file(hexapod_with("coulomb_N: 15.0", "coulomb_N: -15.0"), ""); }),
              ElementsAre(::testing::HasSubstr("drive_friction.coulomb_N")));
}

TEST(HexapodFile, HasDrivesThatSlide) {
  const std::string file = "kind: hexapod_6ups\ndrives: {max_torque_Nm: 3}\n";
  EXPECT_THAT(problems_of([&] { parse_robot_file(file, "hexapod.yaml"); }),
              Contains(::testing::StartsWith("hexapod.yaml:2: drives.max_torque_Nm: ")));
}

TEST(HexapodFile, TellsWhichBodyIsNone) {
  const std::string text = hexapod_with("[0.030, 0.030, 0.0016]", "[0.030, 0.030, 0.9999]");
  EXPECT_THAT(problems_of([&] { parse_robot_file(text, "hexapod.yaml"); }),
              ElementsAre(::testing::HasSubstr(
                  "cylinder.inertia_kg_m2: has the principal moments   0.03   0.03 0.9999 kg m^2;")));
}

}  // namespace
}  // namespace flinch
