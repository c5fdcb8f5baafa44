#include "experiments/scenario/robot_input.h"

#include "experiments/scenario/scenario.h"
#include "systems/config/config_file.h"
#include "systems/config/file_kind.h"

namespace flinch {

RobotInput read_robot_input(const std::filesystem::path& file) {
  if (kind_of(file) == FileKind::robot) return {read_robot_file(file), read_config_file(file)};
  const Scenario scenario = read_scenario(file);
  RobotInput input{scenario.robot, scenario.robot_text};
  input.robot.control_period = scenario.control_period;
  return input;
}

}  // namespace flinch
