#include "systems/robot/link_segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/robot/mechanism.h"

namespace flinch {
namespace {

using Point = Eigen::Vector3d;

Point in_space(const CartesianVector& v) { return {v[0], v[1], v.size() == 3 ? v[2] : 0.0}; }

// Fraction along a segment of the point closest to another one, from the projection and the squared length.
double clamped_fraction(double projection, double squared_length) {
  return squared_length > 0.0 ? std::clamp(projection / squared_length, 0.0, 1.0) : 0.0;
}

// Minimises |r + s d_a - t d_b| over 0 <= s, t <= 1: the free minimum over s, then t for that s; where t had
// to be clamped, s again for that t.
SegmentDistance closest_points(const Point& begin_a, const Point& end_a, const Point& begin_b,
                               const Point& end_b) {
  const Point d_a = end_a - begin_a;
  const Point d_b = end_b - begin_b;
  const Point r = begin_a - begin_b;
  const double aa = d_a.squaredNorm();
  const double bb = d_b.squaredNorm();
  const double ab = d_a.dot(d_b);
  const double ar = d_a.dot(r);
  const double br = d_b.dot(r);

  // The determinant vanishes for parallel segments; any s on segment a then serves as a start.
  const double determinant = aa * bb - ab * ab;
  const bool parallel = determinant <= std::numeric_limits<double>::epsilon() * aa * bb;
  SegmentDistance result;
  result.fraction_a = parallel ? 0.0 : std::clamp((ab * br - ar * bb) / determinant, 0.0, 1.0);
  result.fraction_b = clamped_fraction(ab * result.fraction_a + br, bb);
  result.fraction_a = clamped_fraction(ab * result.fraction_b - ar, aa);
  result.distance = (r + result.fraction_a * d_a - result.fraction_b * d_b).norm();
  return result;
}

/// The axis of a link and the sphere about its middle that holds it.
struct Link {
  Point begin, end;
  Point middle;
  double radius;
};

}  // namespace

SegmentDistance segment_distance(const Segment& a, const Segment& b) noexcept {
  return closest_points(in_space(a.begin), in_space(a.end), in_space(b.begin), in_space(b.end));
}

Segment link_segment(const Kinematics& kinematics, BodyId link) noexcept {
  return link_segment(kinematics.legs, link);
}

Segment link_segment(const std::array<LegPoints, max_dof>& legs, BodyId link) noexcept {
  const LegPoints& leg = legs[static_cast<std::size_t>(link.leg())];
  if (link.is_link1()) return {leg.base_joint, leg.passive_joint};
  return {leg.passive_joint, leg.coupling_joint};
}

/// The distance of each pair of links of different legs, so far as it is within `margin` of the smallest one
/// found before it, is told to `see`. A pair whose spheres about the middles of its links are farther apart
/// than that is passed over.
template <class See>
double smallest_distance(const Mechanism& mechanism, const Kinematics& kinematics, double margin, See&& see) {
  std::array<Link, max_bodies> links;
  for (int i = 1; i < mechanism.body_count(); ++i) {
    const Segment link = link_segment(kinematics, BodyId::from_index(i));
    const Point begin = in_space(link.begin);
    const Point end = in_space(link.end);
    links[static_cast<std::size_t>(i)] = {begin, end, 0.5 * (begin + end), 0.5 * (end - begin).norm()};
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (const BodyPair& pair : mechanism.description().self_collision_pairs) {
    const Link& a = links[static_cast<std::size_t>(pair.a)];
    const Link& b = links[static_cast<std::size_t>(pair.b)];
    const double nearest = a.radius + b.radius + smallest + margin;
    if ((a.middle - b.middle).squaredNorm() > nearest * nearest) continue;
    const SegmentDistance between = closest_points(a.begin, a.end, b.begin, b.end);
    smallest = std::min(smallest, between.distance);
    if (between.distance <= smallest + margin) see(NearestLinks{pair, between});
  }
  return smallest;
}

double self_collision_distance(const Mechanism& mechanism, const Kinematics& kinematics) noexcept {
  if (!kinematics.reachable) return 0.0;
  return smallest_distance(mechanism, kinematics, 0.0, [](const NearestLinks&) {});
}

NearestLinksList nearest_links(const Mechanism& mechanism, const Kinematics& kinematics,
                               double margin) noexcept {
  NearestLinksList nearest;
  if (!kinematics.reachable) return nearest;
  const auto drop_beyond = [&nearest](double limit) {
    const auto beyond = [limit](const NearestLinks& each) { return each.segments.distance > limit; };
    const auto end = nearest.links.begin() + nearest.count;
    nearest.count =
        static_cast<int>(std::remove_if(nearest.links.begin(), end, beyond) - nearest.links.begin());
  };
  const double smallest = smallest_distance(mechanism, kinematics, margin, [&](const NearestLinks& found) {
    drop_beyond(found.segments.distance + margin);
    if (nearest.count == max_nearest_links) return;
    nearest.links[static_cast<std::size_t>(nearest.count++)] = found;
  });
  drop_beyond(smallest + margin);
  return nearest;
}

}  // namespace flinch
