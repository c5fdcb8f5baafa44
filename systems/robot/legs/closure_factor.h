#pragma once

#include <Eigen/Core>

#include "systems/robot/legs/leg_closure.h"

namespace flinch {

/// J of a leg's closures (c x k, c >= k), factored so that equations with it can be solved: an inverse where
/// it is square and small, Q U otherwise.
class ClosureFactor {
 public:
  void compute(const ClosureMatrix& J) noexcept;

  /// J^+ B, the solution of least squares.
  template <class Right, class Solution>
  void solve(const Right& B, Solution& X) const noexcept;
  /// N B, whose rows are what no motion of the leg can bring about: c - k rows.
  template <class Right>
  Right rest(const Right& B) const noexcept;

  int rest_rows() const noexcept { return static_cast<int>(matrix_.rows() - matrix_.cols()); }
  /// det J of a square J. Otherwise det U times det Q, whose square is det J^T J.
  double determinant() const noexcept { return determinant_; }
  /// tr(J^+ dJ): d ln |determinant| / dt.
  double determinant_rate(const ClosureMatrix& dJ) const noexcept;

 private:
  using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_leg_coordinates, 1>;

  void invert() noexcept;
  void reflect() noexcept;
  /// Q^T B
  template <class Right>
  void apply_q_transposed(Right& B) const noexcept;

  ClosureMatrix matrix_;       ///< U above the diagonal, reflections below it; or the inverse.
  Coefficients coefficients_;  ///< Of the reflections.
  bool is_inverse_ = false;
  double determinant_ = 0.0;
};

// Reflection j: I - coefficient u u^T with u = (0, ..., 0, 1, below the diagonal).
template <class Right>
void ClosureFactor::apply_q_transposed(Right& B) const noexcept {
  const Eigen::Index rows = matrix_.rows();
  for (Eigen::Index j = 0; j < matrix_.cols(); ++j) {
    for (Eigen::Index i = 0; i < B.cols(); ++i) {
      double along = B(j, i);
      for (Eigen::Index r = j + 1; r < rows; ++r) along += matrix_(r, j) * B(r, i);
      along *= coefficients_[j];
      B(j, i) -= along;
      for (Eigen::Index r = j + 1; r < rows; ++r) B(r, i) -= along * matrix_(r, j);
    }
  }
}

template <class Right, class Solution>
void ClosureFactor::solve(const Right& B, Solution& X) const noexcept {
  const Eigen::Index k = matrix_.cols();
  X.resize(k, B.cols());
  if (is_inverse_) {
    X.noalias() = matrix_.lazyProduct(B);
    return;
  }
  Right turned = B;
  apply_q_transposed(turned);
  for (Eigen::Index i = 0; i < B.cols(); ++i) {
    for (Eigen::Index j = k - 1; j >= 0; --j) {
      double sum = turned(j, i);
      for (Eigen::Index m = j + 1; m < k; ++m) sum -= matrix_(j, m) * X(m, i);
      X(j, i) = sum / matrix_(j, j);
    }
  }
}

template <class Right>
Right ClosureFactor::rest(const Right& B) const noexcept {
  Right turned = B;
  if (rest_rows() == 0) return turned.topRows(0);
  apply_q_transposed(turned);
  return Right(turned.bottomRows(rest_rows()));
}

}  // namespace flinch
