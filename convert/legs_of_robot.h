#pragma once

#include <filesystem>
#include <string>

#include "systems/robot/legs/legs_parameters.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// A robot with closed forms of its own, as one of kind `legs` that moves alike: planar 3-RRR, five-bar or
/// hexapod. Of a planar leg three numbers are known of its inertia; its links are two of many that have
/// these. Throws SetupError for other mechanisms, and for inertia that no two links have.
LegsParameters as_legs(const ParallelRobot& robot);

/// The same of a robot file, `text` of `file`, that tells `robot`: of kind `legs` what it says.
LegsParameters as_legs(const ParallelRobot& robot, const std::string& text,
                       const std::filesystem::path& file);

}  // namespace flinch
