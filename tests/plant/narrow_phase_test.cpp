// Distances of shapes in space against closed forms, against certificates that need no second algorithm, and
// against differences in time.
#include "plant/narrow_phase.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <vector>

#include "systems/framework/random.h"
#include "systems/robot/link_segments.h"
#include "systems/robot/rotation.h"

namespace flinch {
namespace {

constexpr int pairs = 4000;

class RandomShapes {
 public:
  explicit RandomShapes(std::uint64_t seed) : random_(seed) {}

  double between(double low, double high) { return random_.uniform(low, high); }
  Eigen::Vector3d vector(double size) {
    return size * Eigen::Vector3d(between(-1.0, 1.0), between(-1.0, 1.0), between(-1.0, 1.0));
  }
  Eigen::Matrix3d axes() { return rotation_matrix(quaternion_exp(vector(2.0))); }
  Placement placement(double reach) { return {vector(reach), axes()}; }

  Sphere sphere() { return {.centre = vector(0.05), .radius = between(0.01, 0.1)}; }
  Capsule capsule() { return {.begin = vector(0.2), .end = vector(0.2), .radius = between(0.01, 0.1)}; }
  Box box() {
    return {.centre = vector(0.05),
            .axes = axes(),
            .half_lengths = {between(0.02, 0.2), between(0.02, 0.2), between(0.02, 0.2)}};
  }
  /// A prism of so many sides, such as the platform of a hexapod.
  ConvexHull prism(int sides) {
    ConvexHull hull{.points = {}, .margin = 0.0};
    const double radius = between(0.05, 0.3), low = between(-0.1, -0.02), high = between(0.02, 0.1);
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      for (const double z : {low, high})
        hull.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return hull;
  }

 private:
  RandomGenerator random_;
};

Eigen::Vector3d in_base(const Placement& at, const Eigen::Vector3d& point) {
  return at.origin + at.axes * point;
}

Eigen::Vector3d in_body(const Placement& at, const Eigen::Vector3d& point) {
  return at.axes.transpose() * (point - at.origin);
}

// ---------------------------------------------------------------- closed forms

/// Distance of a point from the surface of a box, negative inside; in axes of the box.
double distance_from_box(const Eigen::Vector3d& point, const Eigen::Vector3d& half) {
  const Eigen::Vector3d beyond = point.cwiseAbs() - half;
  return beyond.maxCoeff() > 0.0 ? beyond.cwiseMax(0.0).norm() : beyond.maxCoeff();
}

TEST(SphereAndBox, AreAsFarApartAsTheCentreIsFromTheBox) {
  RandomShapes random(1);
  double apart = 0.0, inside = 0.0;
  int overlapping = 0;
  for (int i = 0; i < pairs; ++i) {
    const Sphere sphere = random.sphere();
    const Box box = random.box();
    const Placement at_sphere = random.placement(0.25), at_box = random.placement(0.1);
    const Eigen::Vector3d centre = in_body(at_box, in_base(at_sphere, sphere.centre));
    const double exact =
        distance_from_box(box.axes.transpose() * (centre - box.centre), box.half_lengths) - sphere.radius;
    const double error = std::abs(nearest(Solid(sphere), at_sphere, Solid(box), at_box).gap - exact);
    const bool centre_is_inside = exact < -sphere.radius;
    overlapping += exact < 0.0 ? 1 : 0;
    (centre_is_inside ? inside : apart) = std::max(centre_is_inside ? inside : apart, error);
  }
  std::cout << "sphere and box: " << apart << " m, where the centre is inside " << inside << " m, "
            << overlapping << " overlap\n";
  EXPECT_LT(apart, 1e-14);
  EXPECT_LT(inside, 1e-11);
  EXPECT_GT(overlapping, pairs / 5);
}

TEST(Capsules, AreAsFarApartAsTheirSegments) {
  RandomShapes random(2);
  double worst = 0.0;
  int overlapping = 0;
  for (int i = 0; i < pairs; ++i) {
    const Capsule a = random.capsule(), b = random.capsule();
    const Placement at_a = random.placement(0.15), at_b = random.placement(0.15);
    const Segment axis_a{in_base(at_a, a.begin), in_base(at_a, a.end)};
    const Segment axis_b{in_base(at_b, b.begin), in_base(at_b, b.end)};
    const double between_axes = segment_distance(axis_a, axis_b).distance;
    if (between_axes < 1e-4) continue;  // axes that cross have no direction from one to the other
    const double exact = between_axes - a.radius - b.radius;
    overlapping += exact < 0.0 ? 1 : 0;
    worst = std::max(worst, std::abs(nearest(Solid(a), at_a, Solid(b), at_b).gap - exact));
  }
  std::cout << "capsules: " << worst << " m, " << overlapping << " overlap\n";
  EXPECT_LT(worst, 1e-12);
  EXPECT_GT(overlapping, pairs / 4);
}

std::array<Eigen::Vector3d, 8> corners(const Box& box, const Placement& at) {
  std::array<Eigen::Vector3d, 8> found;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0,
                                (i & 4) != 0 ? 1.0 : -1.0);
    found[static_cast<std::size_t>(i)] =
        in_base(at, box.centre + box.axes * signs.cwiseProduct(box.half_lengths));
  }
  return found;
}

/// How far `b` lies beyond `a` along `n`; negative where they overlap. It is never more than the gap.
double gap_along(const Eigen::Vector3d& n, const auto& a, const auto& b) {
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  for (const Eigen::Vector3d& point : a) from = std::max(from, n.dot(point));
  for (const Eigen::Vector3d& point : b) to = std::min(to, n.dot(point));
  return to - from;
}

// The axes along which boxes can be told apart: normals of their faces and products of their edges.
TEST(BoxesThatOverlap, PenetrateAsFarAlongTheBestOfFifteenAxes) {
  RandomShapes random(3);
  double worst = 0.0, worst_deep = 0.0;
  int overlapping = 0, shallow = 0;
  for (int i = 0; i < pairs; ++i) {
    const Box a = random.box(), b = random.box();
    const Placement at_a = random.placement(0.15), at_b = random.placement(0.15);
    const auto of_a = corners(a, at_a), of_b = corners(b, at_b);
    const Eigen::Matrix3d edges_a = at_a.axes * a.axes, edges_b = at_b.axes * b.axes;
    double exact = -std::numeric_limits<double>::infinity();
    const auto try_axis = [&](const Eigen::Vector3d& axis) {
      if (axis.norm() < 1e-3) return;  // as good as parallel edges: a face does as well
      exact = std::max(
          {exact, gap_along(axis.normalized(), of_a, of_b), gap_along(-axis.normalized(), of_a, of_b)});
    };
    for (int j = 0; j < 3; ++j) {
      try_axis(edges_a.col(j));
      try_axis(edges_b.col(j));
      for (int k = 0; k < 3; ++k) try_axis(edges_a.col(j).cross(edges_b.col(k)));
    }
    if (exact >= 0.0) continue;
    ++overlapping;
    const double error = std::abs(nearest(Solid(a), at_a, Solid(b), at_b).gap - exact);
    double& kept = exact > -0.05 ? worst : worst_deep;
    kept = std::max(kept, error);
    shallow += exact > -0.05 ? 1 : 0;
  }
  std::cout << "boxes: " << worst << " m up to a depth of 50 mm, " << worst_deep << " m beyond it, "
            << shallow << " and " << overlapping - shallow << " overlap\n";
  EXPECT_LT(worst, 1e-10);
  EXPECT_LT(worst_deep, 1e-3) << "the search ends early where boxes lie deep in one another";
  EXPECT_GT(shallow, pairs / 8);
}

// Two shapes in Bullet, one outline: each search ends early, if it does, at another place.
TEST(HullOfTheCornersOfABox, IsAsFarFromAnythingAsTheBox) {
  RandomShapes random(6);
  double from_round = 0.0, from_prism = 0.0, deep_in_prism = 0.0;
  int overlapping = 0;
  for (int i = 0; i < pairs; ++i) {
    const Box box = random.box();
    const auto points = corners(box, {});
    const Solid as_box(box), as_hull(ConvexHull{.points = {points.begin(), points.end()}});
    const Placement at = random.placement(0.1), at_other = random.placement(0.25);
    const auto compare = [&](const Solid& other, double& worst, double& worst_deep) {
      const double of_box = nearest(as_box, at, other, at_other).gap;
      const double of_hull = nearest(as_hull, at, other, at_other).gap;
      double& kept = of_box > -0.02 ? worst : worst_deep;
      kept = std::max(kept, std::abs(of_hull - of_box));
      overlapping += of_box < 0.0 ? 1 : 0;
    };
    compare(Solid(random.sphere()), from_round, from_round);
    compare(Solid(random.capsule()), from_round, from_round);
    compare(Solid(random.prism(12)), from_prism, deep_in_prism);
    const AxisBox around_box = as_box.box(at), around_hull = as_hull.box(at);
    EXPECT_GE((around_box.low - around_hull.low).minCoeff(), -1e-12);
    EXPECT_GE((around_hull.high - around_box.high).minCoeff(), -1e-12);
  }
  std::cout << "hull and box: from round shapes " << from_round << " m, from a prism " << from_prism
            << " m up to a depth of 20 mm and " << deep_in_prism << " m beyond it, " << overlapping
            << " overlap\n";
  EXPECT_LT(from_round, 1e-10);
  EXPECT_LT(from_prism, 1e-10);
  EXPECT_LT(deep_in_prism, 5e-3) << "the search ends early where hulls lie deep in one another";
  EXPECT_GT(overlapping, pairs / 4);
}

// ---------------------------------------------------------------- certificates

std::vector<Eigen::Vector3d> placed(const ConvexHull& hull, const Placement& at) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : hull.points) points.push_back(in_base(at, point));
  return points;
}

/// How far a point is beyond the face of a regular prism, as `prism` makes it, that it is farthest from.
double beyond_faces(const ConvexHull& prism, const Eigen::Vector3d& point) {
  const auto sides = static_cast<int>(prism.points.size() / 2);
  const double apothem = prism.points[0].head<2>().norm() * std::cos(std::numbers::pi / sides);
  double beyond = std::max(prism.points[0].z() - point.z(), point.z() - prism.points[1].z());
  for (int i = 0; i < sides; ++i) {
    const double angle = std::numbers::pi * (2 * i + 1) / sides;
    beyond = std::max(beyond, point.x() * std::cos(angle) + point.y() * std::sin(angle) - apothem);
  }
  return beyond;
}

// A direction along which two hulls lie a distance apart shows that they are no nearer; two of their points
// at that distance, that they are no farther.
TEST(HullsApart, HaveADirectionAndTwoPointsThatProveTheirDistance) {
  RandomShapes random(4);
  double by_direction = 0.0, by_points = 0.0;
  int apart = 0;
  for (int i = 0; i < pairs; ++i) {
    const ConvexHull a = random.prism(12), b = random.prism(5);
    const Placement at_a = random.placement(0.4), at_b = random.placement(0.4);
    const SurfaceGap found = nearest(Solid(a), at_a, Solid(b), at_b);
    if (found.gap <= 1e-6) continue;
    ++apart;
    by_direction = std::max(by_direction,
                            std::abs(gap_along(found.normal, placed(a, at_a), placed(b, at_b)) - found.gap));
    const Eigen::Vector3d to_surface = 0.5 * found.gap * found.normal;
    by_points = std::max({by_points, beyond_faces(a, in_body(at_a, found.point - to_surface)),
                          beyond_faces(b, in_body(at_b, found.point + to_surface))});
  }
  std::cout << "hulls: " << by_direction << " m by the direction, " << by_points << " m by the points, of "
            << apart << "\n";
  EXPECT_LT(by_direction, 1e-12);
  EXPECT_LT(by_points, 1e-11);
  EXPECT_GT(apart, pairs / 4);
}

// ---------------------------------------------------------------- rates

/// A placement that moves: velocity of its origin and angular velocity, in the base frame.
struct Moving {
  Placement start;
  Eigen::Vector3d velocity, angular_velocity;

  Placement at(double t) const {
    return {start.origin + t * velocity, rotation_matrix(quaternion_exp(t * angular_velocity)) * start.axes};
  }
  Eigen::Vector3d velocity_of(const Eigen::Vector3d& point) const {
    return velocity + angular_velocity.cross(point - start.origin);
  }
};

// The rate of a gap is the velocity of one surface against the other along the normal, at any point of the
// common normal. Where another pair of points takes over just then, the gap has no rate.
TEST(GapsOfMovingShapes, ChangeAsTheirSurfacesMoveAlongTheNormal) {
  RandomShapes random(5);
  const auto any_shape = [&](int kind) -> Shape {
    if (kind == 0) return random.sphere();
    if (kind == 1) return random.capsule();
    if (kind == 2) return random.box();
    return random.prism(12);
  };
  const auto moving = [&] { return Moving{random.placement(0.25), random.vector(1.0), random.vector(3.0)}; };
  constexpr double h = 1e-6;
  std::vector<double> errors;
  for (int i = 0; i < pairs; ++i) {
    const Solid a(any_shape(i % 4)), b(any_shape(i / 4 % 4));
    const Moving of_a = moving(), of_b = moving();
    const auto gap_at = [&](double t) { return nearest(a, of_a.at(t), b, of_b.at(t)); };
    const SurfaceGap now = gap_at(0.0);
    const double rate = now.normal.dot(of_b.velocity_of(now.point) - of_a.velocity_of(now.point));
    errors.push_back(std::abs((gap_at(h).gap - gap_at(-h).gap) / (2.0 * h) - rate));
  }
  std::sort(errors.begin(), errors.end());
  std::cout << "rate of the gap: " << errors[pairs / 2] << " m/s in the median, " << errors[pairs * 99 / 100]
            << " m/s at the 99th percentile\n";
  EXPECT_LT(errors[pairs / 2], 1e-8);
  EXPECT_LT(errors[pairs * 99 / 100], 1e-5);
}

}  // namespace
}  // namespace flinch
