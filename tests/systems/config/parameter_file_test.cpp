#include "systems/config/parameter_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/config/config_file.h"
#include "systems/config/config_node.h"
#include "systems/config/robot_file.h"
#include "systems/robot/planar_rrr.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

const std::string hash(64, 'a');

ParameterFile sample() {
  ParameterFile file;
  file.kind = "torque-constant";
  file.date = "2026-11-22";
  file.robot = {"planar_3rrr.yaml", hash};
  file.recordings = {{"out/pulls/run.h5", hash}};
  file.residual_before = 0.7;
  file.residual_after = 0.1 + 0.2;
  file.residual_unit = "Nm";
  for (int i = 0; i < 3; ++i) {
    file.parameters.push_back({.name = "drives.torque_constant_Nm_per_A[" + std::to_string(i) + "]",
                               .value = 6.0 + 0.1 * i,
                               .deviation = 0.01,
                               .unit = "Nm/A",
                               .belongs_to = "robot"});
  }
  file.parameters.push_back(
      {.name = "legs[1].base_parameters.p2_kg_m2", .value = 0.1, .belongs_to = "robot"});
  file.parameters.push_back(
      {.name = "platform.mass_kg", .value = 9.0, .identifiable = false, .belongs_to = "robot"});
  file.parameters.push_back({.name = "offset[0]", .value = -0.25, .unit = "Nm"});
  return file;
}

TEST(ParameterFile, ReadsBackToTheSameNumbers) {
  ParameterFile wrote = sample();
  wrote.settings = {{.key = "control.filter.form", .value = "it's [1, 2]", .unit = "1/s"},
                    {.key = "control.filter.aligned", .value = "true", .unit = ""}};
  const ParameterFile read = parse_parameter_file(parameter_file_text(wrote), "file.yaml");
  EXPECT_EQ(parameter_file_text(read), parameter_file_text(wrote));
  EXPECT_EQ(read.residual_after, 0.1 + 0.2);
  EXPECT_EQ(read.parameters[0].deviation, 0.01);
  EXPECT_EQ(read.parameters[3].deviation, std::nullopt);
  EXPECT_FALSE(read.parameters[4].identifiable);
  ASSERT_EQ(read.settings.size(), 2U);
  EXPECT_EQ(read.settings[0].value, "it's [1, 2]");
}

TEST(ParameterFile, TakesThePlaceOfWhatTheRobotFileSays) {
  const std::string file = FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml";
  const RobotFile robot =
      parse_robot_file(with_parameters(read_config_file(file), file, sample()), "calibrated");
  EXPECT_EQ(robot.drives.torque_constant, Eigen::Vector3d(6.0, 6.1, 6.0 + 0.1 * 2));
  const auto& parameters = dynamic_cast<const PlanarRrr&>(*robot.robot).parameters();
  EXPECT_EQ(parameters.legs[1].inertia.p2, 0.1);
  EXPECT_EQ(parameters.legs[0].inertia.p2, 0.0965503) << "the legs share one anchor";
  EXPECT_EQ(parameters.platform_mass, 0.642) << "what was not identifiable is not taken over";
}

TEST(ParameterFile, TakesAListOnlyAsAWhole) {
  ParameterFile file = sample();
  file.parameters.erase(file.parameters.begin());
  EXPECT_THAT(test::problems_of([&] { with_parameters("drives: {}", "robot.yaml", file); }),
              Contains(HasSubstr("stands where 'drives.torque_constant_Nm_per_A[0]' should")));
}

TEST(ParameterFile, WithSectionsForControlMayBeOfSeveralRobots) {
  ParameterFile thresholds;
  thresholds.kind = "thresholds";
  thresholds.date = "2026-11-27";
  const std::string head = parameter_file_text(thresholds);
  EXPECT_THAT(test::problems_of([&] { parse_parameter_file(head, "file.yaml"); }),
              Contains(HasSubstr("robot")));
  const ParameterFile read = parse_parameter_file(head + "control: {contact_detector: {}}\n", "file.yaml");
  EXPECT_EQ(read.robot.sha256, "");
  EXPECT_EQ(read.nodes->entries.back().key, "control");
}

TEST(ParameterFile, TellsAllThatIsWrongWithIt) {
  const auto problems = test::problems_of([] {
    parse_parameter_file(
        "flinch_calibration: 2\nkind: dynamics\nrobot: {file: a, sha256: abc}\n"
        "parameters:\n  - {name: a, belongs_to: robt}\n",
        "file.yaml");
  });
  EXPECT_THAT(problems, Contains(HasSubstr("flinch_calibration")));
  EXPECT_THAT(problems, Contains(HasSubstr("date")));
  EXPECT_THAT(problems, Contains(HasSubstr("parameters[0].value")));
}

}  // namespace
}  // namespace flinch
