#include "plant/planar_gap.h"

#include <algorithm>
#include <cmath>

namespace flinch {

DiscGap gap_to_disc(const PlanarCapsule& capsule, const Disc& disc) noexcept {
  const Eigen::Vector2d axis = capsule.end - capsule.begin;
  const double length_squared = axis.squaredNorm();
  const double along = (disc.centre - capsule.begin).dot(axis);

  DiscGap nearest;
  nearest.fraction = length_squared > 0.0 ? std::clamp(along / length_squared, 0.0, 1.0) : 0.0;
  nearest.axis_point = capsule.begin + nearest.fraction * axis;
  const Eigen::Vector2d offset = disc.centre - nearest.axis_point;
  const double distance = offset.norm();
  nearest.gap = distance - capsule.radius - disc.radius;
  if (distance > 0.0) {
    nearest.normal = offset / distance;
  } else if (length_squared > 0.0) {
    nearest.normal = Eigen::Vector2d(-axis.y(), axis.x()) / std::sqrt(length_squared);
  } else {
    nearest.normal = Eigen::Vector2d::UnitX();
  }
  return nearest;
}

}  // namespace flinch
