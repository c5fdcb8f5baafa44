#pragma once

#include <Eigen/Core>

/// Rotations of a body as rotation vectors xi [rad]: axis times angle. Exp(xi) is the rotation matrix.
namespace flinch {

/// S(a) with S(a) b = a x b.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) noexcept {
  Eigen::Matrix3d S;
  S << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return S;
}

/// Unit quaternion (w, x, y, z) of the rotation by `xi`.
Eigen::Vector4d quaternion_exp(const Eigen::Vector3d& xi) noexcept;

/// Rotation vector of a unit quaternion (w, x, y, z), at most pi long; q and -q are one rotation.
Eigen::Vector3d quaternion_log(const Eigen::Vector4d& q) noexcept;

/// The rotation by `b`, then by `a`: a quaternion (w, x, y, z) again.
Eigen::Vector4d quaternion_product(const Eigen::Vector4d& a, const Eigen::Vector4d& b) noexcept;

/// Rotation matrix of a unit quaternion (w, x, y, z).
Eigen::Matrix3d rotation_matrix(const Eigen::Vector4d& q) noexcept;

/// J_l: where R = Exp(xi) R_0, the angular velocity in the base frame is J_l(xi) dxi/dt. Its transpose is the
/// right Jacobian J_r(xi) = J_l(-xi).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& xi) noexcept;

/// Inverse of `left_jacobian`, for angles below 2 pi.
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& xi) noexcept;

/// Time derivative of J_l(xi) dxi/dt where the second derivative of xi is zero: what a moving chart adds to
/// the angular acceleration [rad/s^2].
Eigen::Vector3d left_jacobian_rate_times(const Eigen::Vector3d& xi, const Eigen::Vector3d& xi_rate) noexcept;

}  // namespace flinch
