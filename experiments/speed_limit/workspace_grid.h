#pragma once

#include <Eigen/Core>
#include <vector>

#include "systems/robot/vectors.h"

namespace flinch {

class ParallelRobot;
struct WorkspaceLimits;

/// Points (x, y) of a square grid at which the robot at rest is within `limits`, with the height and
/// orientation of `pose` [m]. The grid is laid about the middle of what can be reached from `pose` without
/// leaving the limits, with `count` points along its longer side, half a spacing from its edges. Whole mm.
/// Throws SetupError where the robot is not within them at `pose` itself.
std::vector<Eigen::Vector2d> workspace_grid(const ParallelRobot& robot, const WorkspaceLimits& limits,
                                            const Configuration& pose, int count);

}  // namespace flinch
