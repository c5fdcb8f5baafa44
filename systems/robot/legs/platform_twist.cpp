#include "systems/robot/legs/platform_twist.h"

#include <Eigen/Geometry>
#include <cmath>

#include "systems/robot/rotation.h"

namespace flinch {
namespace {

// Of J_l = I + b S + c S^2, and b' / theta, c' / theta: b' = theta db, c' = theta dc.
struct Factors {
  double b, c, db, dc;
};

Factors factors(double theta) {
  const double t2 = theta * theta;
  if (theta < 1e-2) {
    const double t4 = t2 * t2;
    return {0.5 - t2 / 24.0 + t4 / 720.0, 1.0 / 6.0 - t2 / 120.0 + t4 / 5040.0,
            -1.0 / 12.0 + t2 / 180.0 - t4 / 6720.0, -1.0 / 60.0 + t2 / 1260.0 - t4 / 60480.0};
  }
  const double b = (1.0 - std::cos(theta)) / t2;
  const double c = (theta - std::sin(theta)) / (t2 * theta);
  return {b, c, (std::sin(theta) / theta - 2.0 * b) / t2, (b - 3.0 * c) / t2};
}

}  // namespace

Eigen::Matrix<double, 6, 6> chart_map(const ChartNumbers& c) noexcept {
  const Eigen::Vector3d r = c.tail<3>();
  const Factors of = factors(r.norm());
  const Eigen::Matrix3d S = cross_matrix(r);
  Eigen::Matrix<double, 6, 6> X = Eigen::Matrix<double, 6, 6>::Identity();
  X.bottomRightCorner<3, 3>() += of.b * S + of.c * S * S;
  return X;
}

// w = r . dr/dt: dJ_l = w db S + b dS + w dc S^2 + c (dS S + S dS).
Eigen::Matrix<double, 6, 6> chart_map_rate(const ChartNumbers& c, const ChartNumbers& rate) noexcept {
  const Eigen::Vector3d r = c.tail<3>();
  const Eigen::Vector3d r_rate = rate.tail<3>();
  const Factors of = factors(r.norm());
  const double w = r.dot(r_rate);
  const Eigen::Matrix3d S = cross_matrix(r);
  const Eigen::Matrix3d dS = cross_matrix(r_rate);
  Eigen::Matrix<double, 6, 6> dX = Eigen::Matrix<double, 6, 6>::Zero();
  dX.bottomRightCorner<3, 3>() = w * of.db * S + of.b * dS + w * of.dc * (S * S) + of.c * (dS * S + S * dS);
  return dX;
}

Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& xi) noexcept {
  return rotation_matrix(quaternion_exp(xi));
}

Eigen::Vector3d rotation_log(const Eigen::Matrix3d& R) noexcept {
  const Eigen::Quaterniond q(R);
  return quaternion_log({q.w(), q.x(), q.y(), q.z()});
}

}  // namespace flinch
