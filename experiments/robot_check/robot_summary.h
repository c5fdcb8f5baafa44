#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "systems/config/robot_file.h"

namespace flinch {

/// What flinch has understood of a robot file: how the robot moves, what it reaches and where its limits
/// leave it, how near it is to singularities, and what the file leaves to defaults.
std::string robot_summary_text(const RobotFile& file);
nlohmann::ordered_json robot_summary_json(const RobotFile& file);

}  // namespace flinch
