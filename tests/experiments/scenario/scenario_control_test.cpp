// One set of defaults: what a silent file means, what settings of C++ begin with, and what the document says.
#include "experiments/scenario/scenario_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "diagrams/robot_settings.h"
#include "systems/config/config_reader.h"
#include "systems/config/parsed.h"
#include "systems/config/robot_file.h"
#include "tests/support/file_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::StartsWith;

/// What takes effect, by key.
using Values = std::map<std::string, std::string>;

RobotFile robot_called(const std::string& name) {
  return read_robot_file(test::shipped("robots/" + name + ".yaml"));
}

ContactControlSettings settings_of(const RobotFile& file) {
  return settings_for(*file.robot, file.drives, file.limits);
}

/// Reads the section `control` of `text` into `settings`, which may name any stage.
Values read(const std::string& text, const RobotFile& file, ContactControlSettings& settings) {
  settings.stages = known_stages();
  ConfigReader reader = ConfigReader::parse(text, "own.yaml");
  read_control(reader.section("control"), *file.robot, settings);
  Values values;
  for (const ReadValue& value : reader.finish()) values[value.key] = value.value;
  return values;
}

const std::string silent = "control: {}\n";

/// Whether both are finite numbers that differ by no more than three significant digits show.
bool are_rounded_alike(const std::string& a, const std::string& b) {
  std::size_t a_end = 0, b_end = 0;
  try {
    const double x = std::stod(a, &a_end), y = std::stod(b, &b_end);
    return a_end == a.size() && b_end == b.size() && std::isfinite(y) &&
           std::abs(x - y) <= 0.005 * std::abs(y);
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// The keys, of those that both have, of which the values differ.
std::vector<std::string> different(const Values& some, const Values& others, bool rounded = false) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : some) {
    const auto other = others.find(key);
    if (other == others.end() || other->second == value) continue;
    if (!rounded || !are_rounded_alike(value, other->second)) keys.push_back(key);
  }
  return keys;
}

/// The section `control` of the scenario in docs/files.md, which has every key.
std::string documented_control() {
  const std::string document = test::bytes_of(FLINCH_SOURCE_DIR "/docs/files.md");
  const std::size_t begin = document.find("\ncontrol:\n") + 1;
  return document.substr(begin, document.find("\nsensors:\n", begin) + 1 - begin);
}

/// Every number that has a point, and every greater than 1, by a hundredth or by one less.
std::string changed(const std::string& text) {
  static const std::regex number("([ \\[])([0-9]+)(\\.[0-9]+)?(e-[0-9]+)?(?=[,\\]}\\s])");
  std::string result;
  auto from = text.begin();
  for (std::sregex_iterator found(text.begin(), text.end(), number), end; found != end; ++found) {
    const std::smatch& match = *found;
    result.append(from, match[2].first);
    from = match[0].second;
    const double value = std::stod(std::string(match[2].first, match[0].second));
    if (match[3].matched || match[4].matched) {
      result += exact_text(0.99 * value);
    } else {
      result += std::to_string(std::lround(value > 1.0 ? value - 1.0 : value));
    }
  }
  return result.append(from, text.end());
}

class ShippedRobot : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(DefaultsOfControl, ShippedRobot,
                         testing::Values("planar_3rrr", "five_bar", "hexapod_6ups"));

// Settings of C++ that know no robot are those of a silent file, but for what the robot's own file says.
TEST_P(ShippedRobot, HasTheDefaultsOfCpp) {
  const RobotFile file = robot_called(GetParam());
  ContactControlSettings bare, of_robot = settings_of(file);
  bare.drive_torque.torque_constant =
      of_robot.drive_torque.torque_constant;  // of which none is right for all
  const Values of_cpp = read(silent, file, bare), of_file = read(silent, file, of_robot);
  EXPECT_GT(of_file.size(), 150U);
  EXPECT_EQ(of_cpp.size(), of_file.size());
  std::vector<std::string> of_the_robot;
  if (of_robot.tasks.constraints.sigma_sc.safety != bare.tasks.constraints.sigma_sc.safety) {
    of_the_robot = {"control.constraints.self_collision.activation",
                    "control.constraints.self_collision.safety"};
  }
  of_the_robot.emplace_back("control.limits.min_self_collision_distance");
  if (file.drives.max_torque != bare.tasks.levels.largest_torque) {
    of_the_robot.insert(of_the_robot.end(),
                        {"control.tasks.levels.largest_torque", "control.tasks.levels.largest_torque_rate"});
  }
  of_the_robot.insert(of_the_robot.end(),
                      {"control.tasks.levels.velocity_feedforward", "control.tasks.levels.velocity_gain"});
  EXPECT_EQ(different(of_cpp, of_file), of_the_robot);
}

TEST(DefaultsOfControl, FollowTheStagesOfCpp) {
  const RobotFile file = robot_called("planar_3rrr");
  ContactControlSettings settings = settings_of(file);
  const ControlStages of_cpp = settings.stages;
  read(silent, file, settings);
  const ControlStages& of_file = settings.stages;
  EXPECT_EQ(followed_name(of_file.velocities), followed_name(of_cpp.velocities));
  EXPECT_EQ(followed_name(of_file.accelerations), followed_name(of_cpp.accelerations));
  EXPECT_EQ(followed_name(of_file.estimators), followed_name(of_cpp.estimators));
  EXPECT_EQ(followed_name(of_file.detectors), followed_name(of_cpp.detectors));
  EXPECT_EQ(followed_name(of_file.classifiers), followed_name(of_cpp.classifiers));
  EXPECT_EQ(followed_name(of_file.locators), followed_name(of_cpp.locators));
  EXPECT_EQ(followed_name(of_file.nominal_laws), followed_name(of_cpp.nominal_laws));
  EXPECT_EQ(followed_name(of_file.reaction_laws), followed_name(of_cpp.reaction_laws));
}

// A default that the reader had of its own would come back over what is set here.
TEST(DefaultsOfControl, LeaveWhatIsSetAlready) {
  const RobotFile file = robot_called("planar_3rrr");
  ContactControlSettings settings = settings_of(file);
  const Values defaults = read(silent, file, settings);
  const Values set = read(changed(documented_control()), file, settings);
  EXPECT_GT(different(defaults, set).size(), 120U);
  EXPECT_THAT(different(set, read(silent, file, settings)),
              ElementsAre("control.accelerations", "control.detectors", "control.estimators"))
      << "stages are chosen anew";
}

TEST(DefaultsOfControl, AreWhatTheDocumentSays) {
  const RobotFile file = robot_called("planar_3rrr");
  ContactControlSettings settings = settings_of(file), by_document = settings_of(file);
  const Values documented = read(documented_control(), file, by_document);
  EXPECT_THAT(
      different(documented, read(silent, file, settings), true),
      ElementsAre("control.accelerations", "control.detectors", "control.drive_torque.torque_constant",
                  "control.estimators", "control.isolation.drive_deviation",
                  "control.limits.max_condition_number", "control.limits.max_platform_speed"))
      << "of these it says what the default is";
}

TEST(TheStartOfTheForwardKinematics, IsAPoseThatTheLegsReach) {
  const RobotFile file = robot_called("planar_3rrr");
  ContactControlSettings settings = settings_of(file);
  read(silent, file, settings);
  EXPECT_FALSE(settings.forward_kinematics.initial_pose.has_value());
  read("control: {forward_kinematics: {initial_pose: {x_mm: 20, y_mm: -10, phi_deg: 5}}}", file, settings);
  ASSERT_TRUE(settings.forward_kinematics.initial_pose.has_value());
  EXPECT_NEAR((*settings.forward_kinematics.initial_pose)[0], 0.02, 1e-12);
  EXPECT_NEAR((*settings.forward_kinematics.initial_pose)[1], -0.01, 1e-12);
  EXPECT_THAT(test::problems_of(
                  [&] { read("control: {forward_kinematics: {initial_pose: {x_m: 3}}}", file, settings); }),
              ElementsAre("own.yaml:1: control.forward_kinematics.initial_pose: is out of the reach of the "
                          "legs; choose a nearer pose"));
}

TEST(TheLimits, HoldTheHomePose) {
  const RobotFile file = robot_called("hexapod_6ups");
  ContactControlSettings settings = settings_of(file);
  EXPECT_THAT(test::problems_of([&] {
                read("control:\n  limits: {min_self_collision_distance_m: 0.5}\n", file, settings);
              }),
              ElementsAre(StartsWith("own.yaml:2: control.limits: min_self_collision_distance is 0.5 m; it "
                                     "must be at most that at the home pose")));
  settings = settings_of(file);
  const std::string of_the_rig =
      "control: {reaction_laws: [strict_reaction], constraints: {self_collision: {safety_m: 0.17, "
      "activation_m: 0.18}}}";
  EXPECT_THAT(
      test::problems_of([&] { read(of_the_rig, file, settings); }),
      ElementsAre(EndsWith("and strict_reaction keeps no less than constraints.self_collision.safety_m")));
  settings = settings_of(file);
  EXPECT_NO_THROW(read("control: {reaction_laws: [strict_reaction]}", file, settings));
}

}  // namespace
}  // namespace flinch
