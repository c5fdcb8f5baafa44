#include "systems/robot/legs/rest_factor.h"

#include <cmath>

namespace flinch {

void RestFactor::start(int following) noexcept {
  Z_.resize(0, following);
  legs_ = 1.0;
}

void RestFactor::add(const ClosureFactor& leg, const ClosureMap& P_z) noexcept {
  append_rows(Z_, leg.rest(P_z));
  legs_ *= leg.determinant();
}

void RestFactor::factor() noexcept {
  factor_.compute(Z_);
  double product = 1.0;
  for (Eigen::Index i = 0; i < Z_.cols(); ++i) {
    product *= (factor_.hCoeffs()[i] != 0.0 ? -1.0 : 1.0) * factor_.matrixQR()(i, i);
  }
  size_ = std::abs(product);
  determinant_ = legs_ * product;
}

RestFactor::Rows RestFactor::solve(const Rows& B) const noexcept {
  Rows turned = B;
  turned.applyOnTheLeft(factor_.householderQ().adjoint());
  Rows X(Z_.cols(), B.cols());
  for (Eigen::Index i = 0; i < B.cols(); ++i) {
    for (Eigen::Index j = Z_.cols() - 1; j >= 0; --j) {
      double sum = -turned(j, i);
      for (Eigen::Index m = j + 1; m < Z_.cols(); ++m) sum -= factor_.matrixQR()(j, m) * X(m, i);
      X(j, i) = sum / factor_.matrixQR()(j, j);
    }
  }
  return X;
}

}  // namespace flinch
