#pragma once

#include <Eigen/Core>
#include <cmath>

namespace flinch {

/// `value` rounded to a multiple of `resolution`; unchanged where that is zero.
inline double quantised(double value, double resolution) {
  return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

/// The same for every entry.
template <class Vector>
Vector quantised(Vector values, double resolution) {
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = quantised(values[i], resolution);
  return values;
}

}  // namespace flinch
