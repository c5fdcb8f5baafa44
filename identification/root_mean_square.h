#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace flinch {

/// 0 of nothing.
inline double root_mean_square(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

inline double root_mean_square(const std::vector<double>& values) {
  return root_mean_square(
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
}

}  // namespace flinch
