#pragma once

#include <Eigen/Core>
#include <cmath>

#include "systems/robot/decompositions.h"

namespace flinch {

/// `EstimatorHealth::observability` of a chain of `states` integrators of which the first is measured: each
/// is the derivative of the one before. [C; C A; C A^2], its columns scaled to length one, does not depend on
/// the period.
template <int states>
double chain_observability() {
  static_assert(states == 2 || states == 3);
  Eigen::Matrix<double, 3, states> O;
  for (int step = 0; step < 3; ++step) {
    O(step, 0) = 1.0;
    O(step, 1) = step;
    if constexpr (states == 3) O(step, 2) = 0.5 * step * step;
  }
  O.colwise().normalize();
  const Eigen::Matrix<double, states, states> gramian = O.transpose() * O;
  const Eigen::Matrix<double, states, 1> squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, states, states>>(gramian).eigenvalues();
  return std::sqrt(squares[0] / squares[states - 1]);
}

}  // namespace flinch
