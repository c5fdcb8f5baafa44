#pragma once

#include <filesystem>
#include <string>

#include "systems/config/robot_file.h"

namespace flinch {

/// A robot and the text that describes it.
struct RobotInput {
  RobotFile robot;
  std::string text;
};

/// Reads a robot file, or the one that a scenario names, with the control period of the scenario.
/// Throws SetupError with all that is wrong.
RobotInput read_robot_input(const std::filesystem::path& file);

}  // namespace flinch
