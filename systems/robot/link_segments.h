#pragma once

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
Segment link_segment(const Kinematics& kinematics, BodyId link) noexcept;

/// sigma_sc: smallest distance between the link axes of the mechanism's self-collision pairs [m], links
/// without thickness. [SafePR] IV-F. NaN-free: 0 for unreachable kinematics, infinite without a pair.
double self_collision_distance(const Mechanism& mechanism, const Kinematics& kinematics) noexcept;

}  // namespace flinch
