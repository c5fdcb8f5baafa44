#pragma once

#include <Eigen/Core>

namespace flinch {

/// Covariance of the errors of a Kalman filter with at most `size` states, and the mean of their correction.
/// Measurements whose noises are independent are taken one after the other: together they do the same as at
/// once, without an inverse.
template <int size>
struct ErrorCovariance {
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, size, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, size, size>;

  Matrix P;
  Vector correction;  ///< what the measurements since `predict` add to the states

  /// Takes a measurement of c^T x with noise of variance r, whose innovation is `e` where x is the
  /// prediction. Joseph's form, (I - K c^T) P (I - K c^T)^T + K r K^T. Returns e^2 / S of what the
  /// measurements before this one leave.
  double measure(const Vector& c, double r, double e) {
    const Vector Pc = P.lazyProduct(c);
    const double S = c.dot(Pc) + r;
    const Vector K = Pc / S;
    const double left = e - c.dot(correction);
    correction += left * K;
    P.noalias() -= K.lazyProduct(Pc.transpose());
    const Vector right = r * K - P.lazyProduct(c);
    P.noalias() += right.lazyProduct(K.transpose());
    return left * left / S;
  }
};

}  // namespace flinch
