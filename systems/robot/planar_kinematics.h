#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/robot/kinematics.h"
#include "systems/robot/planar_leg.h"
#include "systems/robot/planar_motion.h"

namespace flinch {

/// One Jacobian row per leg.
Eigen::Matrix3d stacked_rows(const PlanarMotion& motion, Eigen::RowVector3d PlanarLegMotion::*row) noexcept;

/// Fills all of `out` but the joint angles from a reachable motion. [SafePR] (1), (2)
void differential_kinematics(const std::array<PlanarLegGeometry, 3>& geometry, const PlanarMotion& motion,
                             Kinematics& out) noexcept;

}  // namespace flinch
