#pragma once

#include <array>

#include "systems/robot/body.h"
#include "systems/robot/body_id.h"
#include "systems/robot/kinematics.h"
#include "systems/robot/vectors.h"

namespace flinch {

class Mechanism;

/// Axis of a link in the base frame, from its proximal to its distal joint [m].
struct Segment {
  CartesianVector begin;
  CartesianVector end;
};

/// Closest points of two segments: fractions 0 ... 1 along each, and their distance [m].
struct SegmentDistance {
  double fraction_a = 0.0;
  double fraction_b = 0.0;
  double distance = 0.0;
};

/// Shortest distance of two segments, in the plane or in space; 0 where they cross. Parallel segments and
/// segments of no length are served.
SegmentDistance segment_distance(const Segment& a, const Segment& b) noexcept;

/// Axis of `link`, which must not be the platform.
Segment link_segment(const std::array<LegPoints, max_dof>& legs, BodyId link) noexcept;
Segment link_segment(const Kinematics& kinematics, BodyId link) noexcept;

/// Two links and where they are nearest to one another.
struct NearestLinks {
  BodyPair bodies;
  SegmentDistance segments;
};

/// The distances of all self-collision pairs that are at most `margin` above the smallest [m]; at most
/// `max_nearest_links` of them, by the order of the pairs. None for unreachable kinematics.
inline constexpr int max_nearest_links = 16;
struct NearestLinksList {
  std::array<NearestLinks, max_nearest_links> links;
  int count = 0;
};
NearestLinksList nearest_links(const Mechanism& mechanism, const Kinematics& kinematics,
                               double margin) noexcept;

/// sigma_sc: smallest distance between the link axes of the mechanism's self-collision pairs [m], links
/// without thickness. [SafePR] IV-F. NaN-free: 0 for unreachable kinematics, infinite without a pair.
double self_collision_distance(const Mechanism& mechanism, const Kinematics& kinematics) noexcept;

}  // namespace flinch
