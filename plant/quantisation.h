#pragma once

#include <Eigen/Core>
#include <cmath>

namespace flinch {

/// `value` rounded to a multiple of `resolution`; unchanged where that is zero.
inline double quantised(double value, double resolution) {
  return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

/// The same for every entry.
inline Eigen::Vector3d quantised(const Eigen::Vector3d& values, double resolution) {
  return {quantised(values.x(), resolution), quantised(values.y(), resolution),
          quantised(values.z(), resolution)};
}

}  // namespace flinch
