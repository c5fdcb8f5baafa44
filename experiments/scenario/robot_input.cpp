#include "experiments/scenario/robot_input.h"

#include "experiments/scenario/scenario.h"
#include "systems/config/config_file.h"
#include "systems/config/config_reader.h"

namespace flinch {

bool is_robot_file(const std::filesystem::path& file) {
  const ConfigReader reader = ConfigReader::open(file);
  return reader.has("kind") || reader.has("legs");
}

RobotInput read_robot_input(const std::filesystem::path& file) {
  if (is_robot_file(file)) return {read_robot_file(file), read_config_file(file)};
  const Scenario scenario = read_scenario(file);
  return {scenario.robot, scenario.robot_text};
}

}  // namespace flinch
