#include "systems/config/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <sstream>

#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using test::Problems;
using test::problems_of;
using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::filesystem::path robots = std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/robots";

void expect_same_friction(const JointFriction& a, const JointFriction& b) {
  EXPECT_EQ(a.viscous, b.viscous);
  EXPECT_EQ(a.coulomb, b.coulomb);
}

// Parameters of the robot in a file, which must be a `Robot`.
template <class Robot>
auto parameters_of(const std::filesystem::path& file) {
  return std::dynamic_pointer_cast<const Robot>(load_robot(file))->parameters();
}

void expect_same_leg(const PlanarLegParameters& a, const PlanarLegParameters& b) {
  EXPECT_EQ(a.base_angle, b.base_angle);
  EXPECT_EQ(a.link1_length, b.link1_length);
  EXPECT_EQ(a.link2_length, b.link2_length);
  EXPECT_EQ(a.elbow_sign, b.elbow_sign);
  EXPECT_EQ(a.inertia.p1, b.inertia.p1);
  EXPECT_EQ(a.inertia.p2, b.inertia.p2);
  EXPECT_EQ(a.inertia.p3, b.inertia.p3);
  EXPECT_EQ(a.rotor_inertia, b.rotor_inertia);
  expect_same_friction(a.active_friction, b.active_friction);
  expect_same_friction(a.passive_friction, b.passive_friction);
}

void expect_same_robot(const PlanarRrrParameters& a, const PlanarRrrParameters& b) {
  EXPECT_EQ(a.name, b.name);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_same_leg(a.legs[i], b.legs[i]);
    EXPECT_EQ(a.legs[i].base_radius, b.legs[i].base_radius);
    EXPECT_EQ(a.legs[i].coupling_angle, b.legs[i].coupling_angle);
  }
  EXPECT_EQ(a.coupling_radius, b.coupling_radius);
  EXPECT_EQ(a.platform_mass, b.platform_mass);
  EXPECT_EQ(a.platform_inertia, b.platform_inertia);
  EXPECT_EQ(a.platform_hull_radius, b.platform_hull_radius);
  EXPECT_EQ(a.link_radius, b.link_radius);
  EXPECT_EQ(a.friction_velocity, b.friction_velocity);
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.home_pose, b.home_pose);
}

// Every planar 3-RRR that ships is one of the published rigs, bit for bit.
TEST(ShippedRobots, AreThePublishedOnes) {
  expect_same_robot(parameters_of<PlanarRrr>(robots / "planar_3rrr.yaml"),
                    rig_robot(RigGeometry::individual, RigFriction::test_rig));
  expect_same_robot(parameters_of<PlanarRrr>(robots / "planar_3rrr_nominal.yaml"),
                    rig_robot(RigGeometry::nominal, RigFriction::simulation));
}

TEST(ShippedRobots, HaveAFiveBarThatIsThePreset) {
  const FiveBarParameters a = parameters_of<FiveBar>(robots / "five_bar.yaml");
  const FiveBarParameters b = five_bar_robot(FiveBarElbows::outward, FiveBarFriction::bearings);
  EXPECT_EQ(a.name, b.name);
  for (std::size_t i = 0; i < 2; ++i) {
    expect_same_leg(a.legs[i], b.legs[i]);
    EXPECT_EQ(a.legs[i].base_joint, b.legs[i].base_joint);
  }
  EXPECT_EQ(a.platform_mass, b.platform_mass);
  EXPECT_EQ(a.platform_radius, b.platform_radius);
  EXPECT_EQ(a.link_radius, b.link_radius);
  EXPECT_EQ(a.friction_velocity, b.friction_velocity);
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.home_pose, b.home_pose);
}

TEST(ShippedRobots, CanAllBeLoaded) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(robots)) {
    EXPECT_GE(load_robot(entry.path())->dof(), 2) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 10);
}

TEST(ShippedRobots, SayWhatTheirDrivesAreGivenAndMayDo) {
  const DriveParameters rig = read_robot_file(robots / "planar_3rrr.yaml").drives;
  EXPECT_EQ(rig.torque_constant, (JointVector{{6.021, 6.6116, 6.7315}}));
  EXPECT_EQ(rig.max_torque, 100.0);
  EXPECT_EQ(rig.max_torque_rate, 20e3);
  EXPECT_EQ(rig.max_torque_jump, 40.0);
  EXPECT_EQ(rig.max_speed, 8.0);
  EXPECT_EQ(rig.max_encoder_rate, 12.0);
  EXPECT_EQ(rig.max_control_error, 25.0 * std::numbers::pi / 180.0);
  EXPECT_EQ(rig.max_unseen_motion, 0.25 * std::numbers::pi / 180.0);
  const DriveParameters silent = read_robot_file(robots / "planar_3rrr_nominal.yaml").drives;
  EXPECT_EQ(silent.torque_constant, (JointVector{{6.1, 6.1, 6.1}}));
  EXPECT_EQ(silent.max_torque_rate, 20e3);

  const DriveParameters hexapod = read_robot_file(robots / "hexapod_6ups.yaml").drives;
  const DriveParameters standard = default_drives(DriveKind::prismatic, 6);
  EXPECT_EQ(hexapod.torque_constant, JointVector::Constant(6, 100.0));
  EXPECT_EQ(hexapod.max_torque, standard.max_torque);
  EXPECT_EQ(hexapod.max_torque_rate, standard.max_torque_rate);
  EXPECT_EQ(hexapod.max_torque_jump, standard.max_torque_jump);
  EXPECT_EQ(hexapod.max_speed, standard.max_speed);
  EXPECT_EQ(hexapod.max_encoder_rate, standard.max_encoder_rate);
  EXPECT_EQ(hexapod.max_control_error, standard.max_control_error);
}

TEST(ShippedRobots, AreLimitedToTheirWorkspaces) {
  const WorkspaceLimits hexapod = read_robot_file(robots / "hexapod_6ups.yaml").limits;
  EXPECT_EQ(hexapod.centre, Eigen::Vector3d(0.0, 0.0, 0.62));
  EXPECT_EQ(hexapod.max_distance, 0.15);
  EXPECT_EQ(hexapod.min_active, 0.51);
  EXPECT_EQ(hexapod.max_active, 0.92);
  const WorkspaceLimits five_bar = read_robot_file(robots / "five_bar.yaml").limits;
  EXPECT_EQ(five_bar.centre, Eigen::Vector2d(0.0, 0.33));
  EXPECT_EQ(five_bar.max_active, 150.0 * std::numbers::pi / 180.0);
}

TEST(ShippedRobots, HaveTheLimitsOfBenchAndSimulation) {
  constexpr double degree = std::numbers::pi / 180.0;
  const WorkspaceLimits rig = read_robot_file(robots / "planar_3rrr.yaml").limits;
  EXPECT_EQ(rig.max_distance, 0.35);
  EXPECT_EQ(rig.max_rotation, 29.0 * degree);
  EXPECT_EQ(rig.min_abs_det_A, 0.2);
  EXPECT_EQ(rig.min_abs_det_B, 0.15);
  EXPECT_EQ(rig.min_self_collision_distance, 0.05);
  EXPECT_EQ(rig.min_active, -35.0 * degree);
  EXPECT_EQ(rig.max_active, 150.0 * degree);
  const WorkspaceLimits simulation = read_robot_file(robots / "planar_3rrr_nominal.yaml").limits;
  EXPECT_EQ(simulation.max_distance, 0.7);
  EXPECT_EQ(simulation.min_active, -150.0 * degree);
}

// All keys that a file leaves to their defaults.
std::set<std::string> defaults_of(const std::filesystem::path& file) {
  std::set<std::string> defaults;
  for (const ReadValue& value : read_robot_file(file).values) {
    if (!value.from_file) defaults.insert(value.key);
  }
  return defaults;
}

TEST(ShippedRobots, SayEveryParameterInTheExplainedFiles) {
  EXPECT_THAT(defaults_of(robots / "planar_3rrr.yaml"),
              ElementsAre("legs[1].rotor_inertia", "legs[2].rotor_inertia"));
  EXPECT_THAT(defaults_of(robots / "five_bar.yaml"), IsEmpty());
  EXPECT_THAT(defaults_of(robots / "hexapod_6ups.yaml"), IsEmpty());
}

// Every name that stands in a key, without the numbers of lists and the units at the ends.
TEST(DocumentOfFiles, NamesEveryKeyOfEveryKindOfRobot) {
  std::ifstream file(FLINCH_SOURCE_DIR "/docs/files.md");
  std::string document((std::istreambuf_iterator<char>(file)), {});
  document = document.substr(document.find("## Robot file"));
  int names = 0;
  for (const char* const robot : {"planar_3rrr.yaml", "five_bar.yaml", "hexapod_6ups.yaml", "delta.yaml"}) {
    for (const ReadValue& value : read_robot_file(robots / robot).values) {
      std::istringstream key(value.key);
      for (std::string name; std::getline(key, name, '.'); ++names) {
        name = name.substr(0, name.find('['));
        EXPECT_NE(document.find('`' + name + '`'), std::string::npos) << name << " of " << value.key;
      }
    }
  }
  EXPECT_GT(names, 200);
}

// ---------------------------------------------------------------- files with one change

class ChangedRobotFile : public ::testing::Test {
 protected:
  // Replaces the n-th (from 0) occurrence.
  void replace(const std::string& from, const std::string& to, int n = 0) {
    std::size_t at = text_.find(from);
    for (; n > 0 && at != std::string::npos; --n) at = text_.find(from, at + 1);
    ASSERT_NE(at, std::string::npos) << from;
    text_.replace(at, from.size(), to);
  }

  std::filesystem::path file() const { return folder_.write("robot.yaml", text_); }
  std::string line(int number) const { return file().string() + ":" + std::to_string(number) + ": "; }
  Problems problems() const {
    return problems_of([this] { load_robot(file()); });
  }

  std::string text_ = R"(kind: planar_3rrr
legs:
  - {base_angle_deg: 90, base_radius_m: 0.6829, coupling_angle_deg: 0,
     link1_length_m: 0.5816, link2_length_m: 0.6198,
     base_parameters: {p1_kg_m2: 0.605363, p2_kg_m2: 0.0965503, p3_kg_m2: 0.1356582}}
  - base_angle_deg: 210
    base_radius_m: 0.6829
    coupling_angle_deg: 120
    link1_length_m: 0.5816
    link2_length_m: 0.6198
    bodies:
      link1: {mass_kg: 2.272, centre_of_mass_m: 0.29, inertia_kg_m2: 0.06404}
      link2: {mass_kg: 0.75, centre_of_mass_m: 0.311, inertia_kg_m2: 0.02401}
  - base_angle_deg: 330
    base_radius_m: 0.6829
    coupling_angle_deg: 240
    link1_length_m: 0.5816
    link2_length_m: 0.6198
    base_parameters: {p1_kg_m2: 0.605363, p2_kg_m2: 0.0965503, p3_kg_m2: 0.1356582}
platform:
  coupling_radius_m: 0.107
  mass_kg: 0.642
  inertia_kg_m2: 0.00367513
  hull_radius_m: 0.137
link_radius_m: 0.03
workspace_limits:
  max_distance_m: 0.35
)";

 private:
  TemporaryFolder folder_;
};

TEST_F(ChangedRobotFile, IsFineUnchanged) { EXPECT_THAT(problems(), IsEmpty()); }

TEST_F(ChangedRobotFile, TakesBodiesInPlaceOfBaseParameters) {
  const PlanarRrrParameters robot = parameters_of<PlanarRrr>(file());
  const LegInertia expected = base_parameters({2.272, 0.29, 0.06404}, {0.75, 0.311, 0.02401}, 0.5816);
  EXPECT_EQ(robot.legs[1].inertia.p1, expected.p1);
  EXPECT_EQ(robot.legs[1].inertia.p2, expected.p2);
  EXPECT_EQ(robot.legs[1].inertia.p3, expected.p3);
  EXPECT_NEAR(robot.legs[1].inertia.p1, robot.legs[0].inertia.p1, 1e-4);
}

TEST_F(ChangedRobotFile, ReadsTheSameFromItsTextAlone) {
  const RobotFile from_text = parse_robot_file(text_, "recorded.yaml");
  EXPECT_EQ(from_text.limits.max_distance, 0.35);
  EXPECT_EQ(from_text.values.size(), read_robot_file(file()).values.size());
  replace("link_radius_m: 0.03", "link_radius_m: 0");
  EXPECT_THAT(problems_of([this] { parse_robot_file(text_, "recorded.yaml"); }),
              ElementsAre("recorded.yaml:25: link_radius_m: is 0 m; it must be positive"));
}

TEST_F(ChangedRobotFile, HasNoLimitsUnlessItSaysSo) {
  replace("workspace_limits:\n  max_distance_m: 0.35\n", "");
  const WorkspaceLimits limits = read_robot_file(file()).limits;
  EXPECT_EQ(limits.max_distance, HUGE_VAL);
  EXPECT_EQ(limits.min_abs_det_A, 0.0);
}

TEST_F(ChangedRobotFile, IsOfAKindThatIsKnown) {
  replace("planar_3rrr", "planar_3rr");
  EXPECT_THAT(problems(), ElementsAre(line(1) + "kind: is 'planar_3rr'; did you mean 'planar_3rrr'?"));
  replace("kind: planar_3rr\n", "kind: hexapod\n");
  EXPECT_THAT(problems(),
              ElementsAre(line(1) +
                          "kind: is 'hexapod'; known are: planar_3rrr, five_bar, hexapod_6ups, legs. Any "
                          "robot of legs is a file of kind 'legs' (docs/files.md); what is none is a kind of "
                          "a program of yours (docs/your_robot.md, section 9)"))
      << "the keys of another robot are not judged";
  replace("kind: hexapod\n", "");
  EXPECT_THAT(
      problems(),
      ElementsAre(line(1) + "kind: is missing; it must be one of planar_3rrr, five_bar, hexapod_6ups, legs"));
}

TEST_F(ChangedRobotFile, HasASoundRobotOfItsKindThoughItIsNoGood) {
  replace("link_radius_m: 0.03", "link_radius_m: nonsense");
  const std::optional<RobotFile> preset = preset_of_kind(file());
  ASSERT_TRUE(preset.has_value());
  EXPECT_EQ(preset->robot->drives(), 3);
  EXPECT_EQ(preset->drives.torque_constant.size(), 3);
  replace("planar_3rrr", "hexapod_6ups");
  EXPECT_EQ(preset_of_kind(file())->robot->dof(), 6);
  replace("hexapod_6ups", "hexapod_6up");
  EXPECT_FALSE(preset_of_kind(file()).has_value());
  EXPECT_FALSE(preset_of_kind(robots / "nowhere.yaml").has_value());
}

constexpr const char* drives_with_cogging =
    "drives:\n  cogging_wavelength_rad: [0.26, 0.26, 0.25]\n  cogging_sine_Nm: [0.3, 0, -0.1]\n";

TEST_F(ChangedRobotFile, SaysHowItsDrivesCog) {
  EXPECT_TRUE(read_robot_file(file()).drives.cogging.is_none());
  replace("platform:\n",
          std::string(drives_with_cogging) + "  cogging_cosine_Nm: [0.0, 0, 0.4]\nplatform:\n");
  const Cogging read = read_robot_file(file()).drives.cogging;
  ASSERT_EQ(read.waves.size(), 1U);
  const CoggingWave& cogging = read.waves[0];
  EXPECT_EQ(cogging.wavelength, (JointVector{{0.26, 0.26, 0.25}}));
  EXPECT_EQ(cogging.sine, (JointVector{{0.3, 0.0, -0.1}}));
  EXPECT_EQ(cogging.cosine, (JointVector{{0.0, 0.0, 0.4}}));
}

TEST_F(ChangedRobotFile, SaysAllOfTheCoggingOrNothing) {
  replace("platform:\n", std::string(drives_with_cogging) + "platform:\n");
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("drives.cogging_cosine_Nm: is missing")));
  replace("[0.26, 0.26, 0.25]", "[0.26, 0, 0.25]");
  EXPECT_THAT(problems(), Contains(HasSubstr("cogging_wavelength_rad[1]: is 0; it must be positive")));
}

TEST_F(ChangedRobotFile, SaysHowFarTorquesAreBehindTheirCurrents) {
  EXPECT_EQ(read_robot_file(file()).drives.torque_delay.size(), 0);
  replace("platform:\n", "drives:\n  torque_delay_ms: [0.25, 0, -0.1]\nplatform:\n");
  EXPECT_TRUE(read_robot_file(file()).drives.torque_delay.isApprox(JointVector{{0.25e-3, 0.0, -0.1e-3}}));
  replace("[0.25, 0, -0.1]", "[0.25, 3, -0.1]");
  EXPECT_THAT(problems(), ElementsAre(HasSubstr("drives.torque_delay_ms[1]: is 3")));
}

TEST_F(ChangedRobotFile, HasOneInertiaALeg) {
  replace("    bodies:\n",
          "    base_parameters: {p1_kg_m2: 0.6, p2_kg_m2: 0.09, p3_kg_m2: 0.13}\n    bodies:\n");
  EXPECT_THAT(
      problems(),
      ElementsAre(line(12) +
                  "legs[1]: has more than one of base_parameters, bodies; it must have only one of them"));
}

TEST_F(ChangedRobotFile, HasSomeInertiaALeg) {
  replace("    base_parameters: {p1_kg_m2: 0.605363, p2_kg_m2: 0.0965503, p3_kg_m2: 0.1356582}\nplatform",
          "platform");
  EXPECT_THAT(
      problems(),
      ElementsAre(line(14) + "legs[2]: has none of base_parameters, bodies; it must have one of them"));
}

TEST_F(ChangedRobotFile, HasThreeLegs) {
  replace("legs:\n", "legs:\n  - {}\n");
  EXPECT_THAT(problems(), Contains(line(2) + "legs: is a list of 4; it must be a list of 3 mappings"));
}

TEST_F(ChangedRobotFile, HasPositiveMasses) {
  replace("mass_kg: 0.642", "mass_kg: -0.642");
  replace("mass_kg: 0.75", "mass_kg: -0.75");
  EXPECT_THAT(problems(),
              ElementsAre(line(13) + "legs[1].bodies.link2.mass_kg: is -0.75; it must be positive",
                          line(22) + "platform.mass_kg: is -0.642 kg; it must be positive"));
}

TEST_F(ChangedRobotFile, HasPositiveDefiniteInertia) {
  replace("p2_kg_m2: 0.0965503", "p2_kg_m2: 0.5", 1);
  replace("p3_kg_m2: 0.1356582", "p3_kg_m2: 0.2356582", 1);
  EXPECT_THAT(
      problems(),
      ElementsAre(line(19) + "legs[2].base_parameters: has (p1 - p2) p2 = 0.0526815 and p3^2 = 0.0555348 "
                             "kg^2 m^4; the first must be greater, or the mass matrix is not positive "
                             "definite"));
}

TEST_F(ChangedRobotFile, HasPositiveBaseParameters) {
  replace("p1_kg_m2: 0.605363", "p1_kg_m2: -0.605363", 1);
  EXPECT_THAT(
      problems(),
      ElementsAre(line(19) + "legs[2].base_parameters.p1_kg_m2: is -0.605363 kg m^2; it must be positive"));
}

TEST_F(ChangedRobotFile, HasFiniteNumbers) {
  replace("hull_radius_m: 0.137", "hull_radius_m: .nan");
  EXPECT_THAT(problems(),
              ElementsAre(line(24) + "platform.hull_radius_m: is .nan; it must be a finite number"));
}

TEST_F(ChangedRobotFile, HasAReachableHomePose) {
  replace("kind:", "home_pose: {x_m: 1.5}\nkind:");
  const Problems found = problems();
  ASSERT_FALSE(found.empty());
  for (const std::string& problem : found) {
    EXPECT_THAT(problem, ::testing::StartsWith(line(1) + "home_pose: is out of reach of legs["));
  }
}

TEST_F(ChangedRobotFile, HasAHomePoseWithinItsLimits) {
  replace("max_distance_m: 0.35", "max_distance_m: 0.35\n  min_active_angle_deg: 30");
  EXPECT_THAT(
      problems(),
      ElementsAre(line(28) + "workspace_limits.min_active_angle_deg: is 0.523599 rad (30 deg); it must be at "
                             "most that at the home pose, 0.44072 rad (25.2514 deg)"));
}

TEST_F(ChangedRobotFile, ExcusesWhatIsMissingFromPhysics) {
  replace("    link1_length_m: 0.5816\n", "    link1_length_kg: 0.5816\n");
  replace("  mass_kg: 0.642\n", "");
  EXPECT_THAT(problems(),
              ElementsAre(line(9) + "legs[1].link1_length_kg: has the wrong unit, kg; write link1_length_m, "
                                    "link1_length_mm or link1_length_cm",
                          line(20) + "platform.mass_kg: is missing; it must be given"));
}

TEST_F(ChangedRobotFile, TellsAllThatIsWrongAtOnce) {
  replace("kind: planar_3rrr", "kind: planar_3rrr\ncolour: red");
  replace("link2_length_m: 0.6198", "link2_lenght_m: 0.6198", 1);
  replace("p3_kg_m2: 0.1356582", "p3_kg_m2: 2.0", 1);
  replace("coupling_radius_m: 0.107", "coupling_radius_mm: 0");
  replace("mass_kg: 0.642", "mass_kg: heavy");
  replace("link_radius_m: 0.03", "link_radius_m: -0.03");
  const Problems found = problems();
  ASSERT_EQ(found.size(), 6U) << ::testing::PrintToString(found);
  const std::array<int, 6> lines = {2, 11, 20, 22, 23, 26};
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_THAT(found[i], ::testing::StartsWith(line(lines[i])));
}

}  // namespace
}  // namespace flinch
