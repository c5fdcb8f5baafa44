#pragma once

#include <Eigen/Core>

/// Vectors and matrices of bounded size: they live on the stack, and one compiled block serves mechanisms of
/// every size. SI units and radians throughout; `ConfigurationSpace` says what the entries mean.
namespace flinch {

/// Largest number of platform coordinates, drives and legs.
inline constexpr int max_dof = 6;
/// Largest number of entries of a stored configuration: a position and a unit quaternion.
inline constexpr int max_stored = 7;
/// Largest number of bodies of a mechanism.
inline constexpr int max_bodies = 16;

/// A configuration x of the platform. Its entries are not a vector: sums and differences are made by
/// `ConfigurationSpace`.
using Configuration = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_stored, 1>;

/// One entry per platform coordinate: velocity v, its derivative, conjugate wrench F, increment xi.
using PlatformVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_dof, 1>;

/// One entry per joint: positions [rad or m], rates, drive torques [Nm] or forces [N].
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_dof, 1>;

/// Maps between platform and joint coordinates.
using PlatformMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_dof, max_dof>;

/// Point, direction or force: 2 rows for a planar, 3 for a spatial robot.
using CartesianVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

/// Map from platform or joint rates to a Cartesian velocity (2 or 3 rows) or angular velocity (1 or 3 rows).
using CartesianJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, max_dof>;

/// How each leg is assembled: an index from 0 on, which the mechanism explains. A leg that can be assembled
/// in one way only has index 0.
using WorkingMode = Eigen::Matrix<int, Eigen::Dynamic, 1, 0, max_dof, 1>;

/// Largest entry of an input that can be a machine's, in SI units: squares and cubes of it stay finite.
inline constexpr double largest_input = 1e9;

/// Whether `v` has `size` entries, all of them numbers that can be a machine's.
template <class Vector>
bool usable(const Vector& v, int size) noexcept {
  return v.size() == size && (v.array().abs() <= largest_input).all();
}

}  // namespace flinch
