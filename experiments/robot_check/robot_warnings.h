#pragma once

#include <string>
#include <vector>

#include "systems/config/robot_file.h"

namespace flinch {

/// Why a robot file that describes a robot may not describe the one that was meant: masses in grams, lengths
/// in millimetres, the inertia of another body, a centre of mass far outside, angles of more than a turn,
/// legs that differ as no two of one robot do, drives that cannot hold it. One sentence each, which begins
/// with the key.
std::vector<std::string> robot_warnings(const RobotFile& file);

}  // namespace flinch
