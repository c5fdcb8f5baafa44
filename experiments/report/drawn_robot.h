#pragma once

#include <string>

#include "experiments/report/report.h"
#include "systems/robot/body.h"

namespace flinch {

class ParallelRobot;

/// The robot as the page draws it: where its legs are fixed, and the outline of its platform.
ReportRobot drawn_robot(const ParallelRobot& robot);

/// An obstacle of this shape about `position` in the base frame [m].
ReportObstacle drawn_obstacle(const std::string& name, const Shape& shape, const Eigen::Vector3d& position);

/// Adds the columns `elbow_1_x`, ... to those of the pose, which must be there: where the links of each leg
/// meet. "No data" where the legs do not reach a pose.
void add_elbows(const ParallelRobot& robot, Report& report);

}  // namespace flinch
