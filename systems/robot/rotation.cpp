#include "systems/robot/rotation.h"

#include <Eigen/Geometry>
#include <cmath>

namespace flinch {
namespace {

constexpr double small_angle = 1e-2;  // below it the series to fourth order are exact to rounding

/// Coefficients of the series in S(xi): J_l = I + b S + c S^2 with b = (1 - cos t)/t^2, c = (t - sin t)/t^3,
/// and their derivatives by t, divided by t.
struct Coefficients {
  double b, c, db, dc;
};

Coefficients coefficients(double t) {
  const double t2 = t * t;
  if (t < small_angle) {
    return {.b = 1.0 / 2.0 - t2 / 24.0 + t2 * t2 / 720.0,
            .c = 1.0 / 6.0 - t2 / 120.0 + t2 * t2 / 5040.0,
            .db = -1.0 / 12.0 + t2 / 180.0 - t2 * t2 / 6720.0,
            .dc = -1.0 / 60.0 + t2 / 1260.0 - t2 * t2 / 60480.0};
  }
  const double b = (1.0 - std::cos(t)) / t2;
  const double c = (t - std::sin(t)) / (t2 * t);
  return {.b = b, .c = c, .db = (std::sin(t) / t - 2.0 * b) / t2, .dc = (b - 3.0 * c) / t2};
}

}  // namespace

Eigen::Vector4d quaternion_exp(const Eigen::Vector3d& xi) noexcept {
  const double t = xi.norm();
  const double half_sinc = t < 1e-4 ? 0.5 - t * t / 48.0 : std::sin(0.5 * t) / t;
  Eigen::Vector4d q;
  q << std::cos(0.5 * t), half_sinc * xi;
  return q;
}

Eigen::Vector3d quaternion_log(const Eigen::Vector4d& q) noexcept {
  const Eigen::Vector4d near = q[0] < 0.0 ? Eigen::Vector4d(-q) : q;
  const Eigen::Vector3d v = near.tail<3>();
  const double s = v.norm();
  if (s < 1e-12) return 2.0 * v;
  return 2.0 * std::atan2(s, near[0]) / s * v;
}

Eigen::Vector4d quaternion_product(const Eigen::Vector4d& a, const Eigen::Vector4d& b) noexcept {
  const Eigen::Vector3d u = a.tail<3>();
  const Eigen::Vector3d v = b.tail<3>();
  Eigen::Vector4d product;
  product << a[0] * b[0] - u.dot(v), a[0] * v + b[0] * u + u.cross(v);
  return product;
}

Eigen::Matrix3d rotation_matrix(const Eigen::Vector4d& q) noexcept {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& xi) noexcept {
  const Coefficients k = coefficients(xi.norm());
  const Eigen::Matrix3d S = cross_matrix(xi);
  return Eigen::Matrix3d::Identity() + k.b * S + k.c * S * S;
}

Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& xi) noexcept {
  const double t = xi.norm();
  const double factor = t < small_angle ? 1.0 / 12.0 + t * t / 720.0 + t * t * t * t / 30240.0
                                        : 1.0 / (t * t) - (1.0 + std::cos(t)) / (2.0 * t * std::sin(t));
  const Eigen::Matrix3d S = cross_matrix(xi);
  return Eigen::Matrix3d::Identity() - 0.5 * S + factor * S * S;
}

Eigen::Vector3d left_jacobian_rate_times(const Eigen::Vector3d& xi, const Eigen::Vector3d& xi_rate) noexcept {
  const Coefficients k = coefficients(xi.norm());
  const double t_times_rate = xi.dot(xi_rate);  // t dt/dt
  const Eigen::Vector3d turned = xi.cross(xi_rate);
  // S(xi_rate) xi_rate = 0; what is left of d/dt (b S + c S^2) xi_rate:
  return k.db * t_times_rate * turned + k.dc * t_times_rate * xi.cross(turned) + k.c * xi_rate.cross(turned);
}

}  // namespace flinch
