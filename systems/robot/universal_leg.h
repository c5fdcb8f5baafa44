#pragma once

#include <Eigen/Core>
#include <cmath>

#include "systems/robot/rotation.h"

namespace flinch {

/// A straight leg on a universal joint: its first axis k is fixed, the second is across both k and the leg.
/// The joint keeps the leg from spinning freely about itself. Base frame; v has n entries.
template <int n>
struct UniversalLeg {
  using Map = Eigen::Matrix<double, 3, n>;
  using Row = Eigen::Matrix<double, 1, n>;

  Eigen::Matrix3d axes;   ///< Columns: across, along the second axis e_2, along the leg.
  Map J_w, dJ_w;          ///< Angular velocity from v, and its time derivative.
  Row J_first, J_second;  ///< Rates about k and about e_2 from v.
  double sine_squared;    ///< Of the angle from k to the leg; 0 at a type-I singularity.
};

/// The leg along the unit vector `s`, whose rate is J_s v. With c = k.s, w = k x s, N = w.w, t = c w / N:
/// J_w = (S(s) + s t^T) J_s. `k` is a unit vector and not along `s`.
template <int n>
UniversalLeg<n> universal_leg(const Eigen::Vector3d& k, const Eigen::Vector3d& s,
                              const Eigen::Vector3d& s_rate, const Eigen::Matrix<double, 3, n>& J_s,
                              const Eigen::Matrix<double, 3, n>& dJ_s) {
  const double c = k.dot(s);
  const double c_rate = k.dot(s_rate);
  const Eigen::Vector3d w = k.cross(s);
  const Eigen::Vector3d w_rate = k.cross(s_rate);
  const double N = w.squaredNorm();
  const Eigen::Vector3d t = c / N * w;
  const Eigen::Vector3d t_rate = (c_rate * w + c * w_rate) / N + 2.0 * c * c * c_rate / (N * N) * w;
  const Eigen::Matrix3d W = cross_matrix(s) + s * t.transpose();
  const Eigen::Matrix3d W_rate = cross_matrix(s_rate) + s_rate * t.transpose() + s * t_rate.transpose();
  const Eigen::Vector3d second = w / std::sqrt(N);

  UniversalLeg<n> leg;
  leg.axes << second.cross(s), second, s;
  leg.J_w = W * J_s;
  leg.dJ_w = W_rate * J_s + W * dJ_s;
  leg.J_first = w.transpose() / N * J_s;
  leg.J_second = second.transpose() * leg.J_w;
  leg.sine_squared = N;
  return leg;
}

}  // namespace flinch
