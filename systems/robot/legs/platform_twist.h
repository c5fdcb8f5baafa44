#pragma once

#include <Eigen/Core>

#include "systems/robot/legs/platform_moves.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Where the platform frame E is, and how it moves with the platform coordinates: base frame.
struct PlatformTwist {
  /// Maps from v to the twist (velocity of the origin of E, angular velocity).
  using Map = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, max_dof>;
  using Twist = Eigen::Matrix<double, 6, 1>;

  Eigen::Vector3d origin{0.0, 0.0, 0.0};               ///< [m]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< R
  Map T;
  Map dT;
  Twist twist = Twist::Zero();  ///< T v

  Eigen::Vector3d omega() const { return twist.tail<3>(); }
};

/// The six chart numbers of a platform: (x, y, z) and the rotation vector from its orientation at home.
using ChartNumbers = Eigen::Matrix<double, 6, 1>;

/// The rates of the chart numbers that follow, and the numbers themselves.
using FollowingVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Twist = X dc/dt with X = blkdiag(I, J_l(r)) for chart numbers c = (p, r).
Eigen::Matrix<double, 6, 6> chart_map(const ChartNumbers& c) noexcept;
/// Its time derivative while c moves with `rate`.
Eigen::Matrix<double, 6, 6> chart_map_rate(const ChartNumbers& c, const ChartNumbers& rate) noexcept;

/// Exp(xi): the rotation matrix of a rotation vector.
Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& xi) noexcept;
/// Log(R): its rotation vector, at most pi long.
Eigen::Vector3d rotation_log(const Eigen::Matrix3d& R) noexcept;

}  // namespace flinch
