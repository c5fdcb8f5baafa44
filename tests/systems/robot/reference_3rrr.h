#pragma once

#include <cmath>
#include <numbers>

#include "systems/robot/planar_rrr_presets.h"

namespace flinch::test {

/// The 3-RRR once more, written straight from its loop closure with the law of cosines and absolute angles;
/// shares no code with the robot under test.
struct ReferenceLeg {
  double psi, r_fix, beta, r_c, l1, l2;

  Eigen::Vector2d base() const { return {r_fix * std::sin(psi), -r_fix * std::cos(psi)}; }
  Eigen::Vector2d coupling(const Eigen::Vector3d& x) const {
    return {x[0] + r_c * std::cos(x[2] + beta), x[1] + r_c * std::sin(x[2] + beta)};
  }
  /// (qa, qp, qc), elbow on the positive side.
  Eigen::Vector3d joints(const Eigen::Vector3d& x) const {
    const Eigen::Vector2d w = coupling(x) - base();
    const double rho = w.norm();
    const double gamma = std::atan2(w.y(), w.x());
    const double eta = std::acos((l1 * l1 + rho * rho - l2 * l2) / (2.0 * l1 * rho));
    const double qp = std::acos((rho * rho - l1 * l1 - l2 * l2) / (2.0 * l1 * l2));
    const double qa = std::remainder(gamma - eta - psi, 2.0 * std::numbers::pi);
    return {qa, qp, std::remainder(x[2] - psi - qa - qp, 2.0 * std::numbers::pi)};
  }
  /// a + l1 u(theta1) + l2 u(theta2) - c
  Eigen::Vector2d closure(const Eigen::Vector3d& x, double qa, double qp) const {
    const double theta1 = psi + qa;
    const double theta2 = theta1 + qp;
    return base() + l1 * Eigen::Vector2d(std::cos(theta1), std::sin(theta1)) +
           l2 * Eigen::Vector2d(std::cos(theta2), std::sin(theta2)) - coupling(x);
  }
};

inline std::vector<ReferenceLeg> reference_legs(RigGeometry geometry) {
  constexpr double degree = std::numbers::pi / 180.0;
  if (geometry == RigGeometry::nominal) {
    return {{90.0 * degree, 0.6829, 0.0, 0.107, 0.5816, 0.6198},
            {210.0 * degree, 0.6829, 120.0 * degree, 0.107, 0.5816, 0.6198},
            {330.0 * degree, 0.6829, 240.0 * degree, 0.107, 0.5816, 0.6198}};
  }
  return {{90.0 * degree, 0.6877, 0.0, 0.107, 0.58152, 0.62002},
          {210.7631 * degree, 0.6922, 120.0 * degree, 0.107, 0.58121, 0.61964},
          {330.4901 * degree, 0.6666, 240.0 * degree, 0.107, 0.58215, 0.61975}};
}

}  // namespace flinch::test
