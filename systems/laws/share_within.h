#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace flinch {

/// The largest share of `wanted`, at most all of it, of which no entry exceeds `largest` in size. So what is
/// too large keeps its direction.
template <class Vector>
double share_within(const Eigen::MatrixBase<Vector>& wanted, double largest) noexcept {
  return std::min(1.0, largest / std::max(wanted.template lpNorm<Eigen::Infinity>(), 1e-300));
}

}  // namespace flinch
