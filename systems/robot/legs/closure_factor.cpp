#include "systems/robot/legs/closure_factor.h"

#include <cmath>

#include "systems/robot/decompositions.h"

namespace flinch {

void ClosureFactor::compute(const ClosureMatrix& J) noexcept {
  matrix_ = J;
  is_inverse_ = J.rows() == J.cols() && (J.rows() == 2 || J.rows() == 3);
  is_inverse_ ? invert() : reflect();
}

void ClosureFactor::invert() noexcept {
  if (matrix_.rows() == 2) {
    const Eigen::Matrix2d J = matrix_;
    determinant_ = J.determinant();
    matrix_ = J.inverse();
  } else {
    const Eigen::Matrix3d J = matrix_;
    determinant_ = J.determinant();
    matrix_ = J.inverse();
  }
}

// Householder, without pivoting.
void ClosureFactor::reflect() noexcept {
  const Eigen::Index rows = matrix_.rows();
  const Eigen::Index columns = matrix_.cols();
  coefficients_.setZero(columns);
  determinant_ = 1.0;
  for (Eigen::Index j = 0; j < columns; ++j) {
    double below = 0.0;
    for (Eigen::Index r = j + 1; r < rows; ++r) below += matrix_(r, j) * matrix_(r, j);
    const double head = matrix_(j, j);
    if (below > 0.0) {
      const double beta = head >= 0.0 ? -std::sqrt(head * head + below) : std::sqrt(head * head + below);
      coefficients_[j] = (beta - head) / beta;
      for (Eigen::Index r = j + 1; r < rows; ++r) matrix_(r, j) /= head - beta;
      matrix_(j, j) = beta;
      determinant_ = -determinant_;
      for (Eigen::Index i = j + 1; i < columns; ++i) {
        double along = matrix_(j, i);
        for (Eigen::Index r = j + 1; r < rows; ++r) along += matrix_(r, j) * matrix_(r, i);
        along *= coefficients_[j];
        matrix_(j, i) -= along;
        for (Eigen::Index r = j + 1; r < rows; ++r) matrix_(r, i) -= along * matrix_(r, j);
      }
    }
    determinant_ *= matrix_(j, j);
  }
}

double ClosureFactor::determinant_rate(const ClosureMatrix& dJ) const noexcept {
  ClosureMatrix X;
  solve(dJ, X);
  return X.trace();
}

}  // namespace flinch
