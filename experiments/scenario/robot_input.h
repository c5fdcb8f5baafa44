#pragma once

#include <filesystem>
#include <string>

#include "systems/config/robot_file.h"

namespace flinch {

/// Whether a YAML file describes a robot, not a scenario. Throws SetupError where it cannot be read.
bool is_robot_file(const std::filesystem::path& file);

/// A robot and the text that describes it.
struct RobotInput {
  RobotFile robot;
  std::string text;
};

/// Reads a robot file, or the one that a scenario names. Throws SetupError with all that is wrong.
RobotInput read_robot_input(const std::filesystem::path& file);

}  // namespace flinch
