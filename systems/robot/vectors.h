#pragma once

#include <Eigen/Core>

/// Vectors and matrices of bounded size: they live on the stack, and one compiled block serves a planar
/// robot with three and a spatial one with six degrees of freedom. SI units and radians throughout.
namespace flinch {

/// Largest number of platform coordinates, drives and legs of a fully-parallel robot.
inline constexpr int max_dof = 6;

/// One entry per platform coordinate: pose x, velocity, wrench. Planar: (x, y, phi) [m, m, rad], wrench
/// (f_x, f_y, m_z) [N, N, Nm] in the base frame with the moment about the platform origin.
using PlatformVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_dof, 1>;

/// One entry per leg: angles [rad], rates [rad/s], drive torques [Nm].
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_dof, 1>;

/// Square maps between platform and joint coordinates.
using PlatformMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_dof, max_dof>;

/// Point, direction or force: 2 rows for a planar, 3 for a spatial robot.
using CartesianVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

/// Map from platform or joint rates to a Cartesian velocity (2 or 3 rows) or angular velocity (1 or 3 rows).
using CartesianJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, max_dof>;

/// Side on which each leg's elbow lies: the sign (+1 or -1) of each passive angle.
using WorkingMode = Eigen::Matrix<int, Eigen::Dynamic, 1, 0, max_dof, 1>;

}  // namespace flinch
