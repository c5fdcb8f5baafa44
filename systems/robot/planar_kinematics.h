#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "systems/robot/kinematics.h"
#include "systems/robot/place_kinematics.h"
#include "systems/robot/planar_leg.h"
#include "systems/robot/planar_motion.h"

namespace flinch {

/// One Jacobian row per leg.
Eigen::Matrix3d stacked_rows(const PlanarMotion& motion, Eigen::RowVector3d PlanarLegMotion::*row) noexcept;

/// J^-1 det J, from its rows.
inline Eigen::Matrix3d adjugate(const Eigen::Matrix3d& J) noexcept {
  const Eigen::Vector3d a = J.row(0), b = J.row(1), c = J.row(2);
  Eigen::Matrix3d adjugate;
  adjugate << b.cross(c), c.cross(a), a.cross(b);
  return adjugate;
}

/// Whether J, which maps platform velocity to drive rates, leaves enough digits to its `inverse`.
bool is_regular(const Eigen::Matrix3d& J, const Eigen::Matrix3d& inverse) noexcept;

/// Fills all of `out` but the joint angles from a reachable motion. [SafePR] (1), (2)
void differential_kinematics(const std::array<PlanarLegGeometry, 3>& geometry, const PlanarMotion& motion,
                             Kinematics& out) noexcept;

/// The same of the place of a reachable motion alone.
void place_kinematics(const std::array<PlanarLegGeometry, 3>& geometry, const PlanarMotion& motion,
                      PlaceKinematics& out) noexcept;

}  // namespace flinch
