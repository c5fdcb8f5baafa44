#pragma once

#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

/// Of each leg whether a push across its first link and one across its second load the robot alike, so that
/// no wrench tells which was pushed: as of a leg that only turns about its end and gets longer. Friction may
/// tell them apart. Of the robot at home.
std::vector<bool> legs_of_alike_links(const ParallelRobot& robot);

}  // namespace flinch
