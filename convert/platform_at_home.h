#pragma once

#include <Eigen/Geometry>

#include "systems/robot/legs/legs_model.h"

namespace flinch {

/// The frame E of the platform in the base frame, where the robot is at home.
Eigen::Isometry3d platform_at_home(const LegsModel& model);

}  // namespace flinch
