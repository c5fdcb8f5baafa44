#include "plant/rope_pull.h"

namespace flinch {

Eigen::Vector3d RopePull::at(double t) const noexcept {
  const double top = to_seconds(start + rise);
  const double descent = to_seconds(start + rise + hold);
  const double end = to_seconds(start + rise + hold + fall);
  if (t < to_seconds(start) || t >= end) return Eigen::Vector3d::Zero();
  if (t < top) return (t - to_seconds(start)) / to_seconds(rise) * peak_in_base;
  if (t < descent) return peak_in_base;
  return (end - t) / to_seconds(fall) * peak_in_base;
}

}  // namespace flinch
