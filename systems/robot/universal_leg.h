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

/// How such a leg turns with the direction s in which it points.
struct UniversalTurn {
  Eigen::Matrix3d axes;       ///< As in UniversalLeg.
  Eigen::Matrix3d W, W_rate;  ///< Angular velocity from ds/dt, and its time derivative.
  Eigen::Vector3d first;      ///< Rate about k is first . ds/dt;
  Eigen::Vector3d second;     ///< rate about e_2, which this is, second . omega.
  double sine_squared;        ///< As in UniversalLeg.
};

/// The leg along the unit vector `s`. With c = k.s, w = k x s, N = w.w, t = c w / N: W = S(s) + s t^T. `k` is
/// a unit vector and not along `s`.
inline UniversalTurn universal_turn(const Eigen::Vector3d& k, const Eigen::Vector3d& s,
                                    const Eigen::Vector3d& s_rate) {
  const double c = k.dot(s);
  const double c_rate = k.dot(s_rate);
  const Eigen::Vector3d w = k.cross(s);
  const Eigen::Vector3d w_rate = k.cross(s_rate);
  const double N = w.squaredNorm();
  const Eigen::Vector3d t = c / N * w;
  const Eigen::Vector3d t_rate = (c_rate * w + c * w_rate) / N + 2.0 * c * c * c_rate / (N * N) * w;

  UniversalTurn turn;
  turn.W = cross_matrix(s) + s * t.transpose();
  turn.W_rate = cross_matrix(s_rate) + s_rate * t.transpose() + s * t_rate.transpose();
  turn.first = w / N;
  turn.second = w / std::sqrt(N);
  turn.axes << turn.second.cross(s), turn.second, s;
  turn.sine_squared = N;
  return turn;
}

/// The leg whose direction changes by J_s v: J_w = W J_s.
template <int n>
UniversalLeg<n> universal_leg(const UniversalTurn& turn, const Eigen::Matrix<double, 3, n>& J_s,
                              const Eigen::Matrix<double, 3, n>& dJ_s) {
  UniversalLeg<n> leg;
  leg.axes = turn.axes;
  leg.J_w = turn.W * J_s;
  leg.dJ_w = turn.W_rate * J_s + turn.W * dJ_s;
  leg.J_first = turn.first.transpose() * J_s;
  leg.J_second = turn.second.transpose() * leg.J_w;
  leg.sine_squared = turn.sine_squared;
  return leg;
}

}  // namespace flinch
