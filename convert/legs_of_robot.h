#pragma once

#include "systems/robot/legs/legs_parameters.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// A robot with closed forms of its own, as one of kind `legs` that moves alike: planar 3-RRR, five-bar or
/// hexapod. Of a planar leg three numbers are known of its inertia; its links are two of many that have
/// these. Throws SetupError for other mechanisms, and for inertia that no two links have.
LegsParameters as_legs(const ParallelRobot& robot);

}  // namespace flinch
