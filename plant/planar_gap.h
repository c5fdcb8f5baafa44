#pragma once

#include <Eigen/Core>

/// Distances in the plane of motion, where every body is a disc or a capsule. Two capsules whose axes do not
/// cross are nearest at one of their ends, so the gap of a disc to a capsule is all that contacts need. [m]
namespace flinch {

struct Disc {
  Eigen::Vector2d centre;
  double radius = 0.0;
};

/// All points within `radius` of the axis from `begin` to `end`.
struct PlanarCapsule {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
  double radius = 0.0;
};

/// Where a capsule and a disc are nearest.
struct DiscGap {
  double gap = 0.0;            ///< Distance of the surfaces; negative where they penetrate.
  double fraction = 0.0;       ///< Of the nearest point on the axis, 0 at its begin and 1 at its end.
  Eigen::Vector2d axis_point;  ///< That point.
  Eigen::Vector2d normal;  ///< Unit vector from it to the disc's centre; square to the axis if they coincide.
};

/// A capsule of no length is a disc.
DiscGap gap_to_disc(const PlanarCapsule& capsule, const Disc& disc) noexcept;

}  // namespace flinch
