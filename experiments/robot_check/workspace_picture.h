#pragma once

#include <string>

#include "systems/config/robot_file.h"

namespace flinch {

/// The robot at home over what it reaches as it is turned there, as SVG: shaded by condition number within
/// the limits, grey beyond them, red beyond a singularity. In the plane seen from above; in space through
/// home, from above and from the front.
std::string workspace_picture(const RobotFile& file);

}  // namespace flinch
