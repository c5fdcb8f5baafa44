#include "systems/robot/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace flinch {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double parallel = 1e-12;  // a line with less of a direction does not come nearer along it

LinePassage joined(const LinePassage& a, const LinePassage& b) {
  if (!a.hits) return b;
  if (!b.hits) return a;
  return {true, std::min(a.enter, b.enter), std::max(a.leave, b.leave)};
}

/// A line through a sphere: |point + s direction - centre| <= radius.
LinePassage through_sphere(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& point,
                           const Eigen::Vector3d& direction) {
  const Eigen::Vector3d to_centre = centre - point;
  const double middle = to_centre.dot(direction);
  const double half_squared = radius * radius - (to_centre - middle * direction).squaredNorm();
  if (half_squared < 0.0) return {};
  return {true, middle - std::sqrt(half_squared), middle + std::sqrt(half_squared)};
}

/// A line through the side of a cylinder, between the planes of its ends.
LinePassage through_cylinder(const Capsule& capsule, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& direction) {
  const double length = (capsule.end - capsule.begin).norm();
  if (length == 0.0) return {};
  const Eigen::Vector3d axis = (capsule.end - capsule.begin) / length;
  const double along = direction.dot(axis);
  const Eigen::Vector3d offset = point - capsule.begin;
  const Eigen::Vector3d across = direction - along * axis;
  const Eigen::Vector3d beside = offset - offset.dot(axis) * axis;
  LinePassage inside{true, -infinite, infinite};
  if (across.norm() > parallel) {
    const double a = across.squaredNorm();
    const double middle = -beside.dot(across) / a;
    const double half = (capsule.radius * capsule.radius - (beside + middle * across).squaredNorm()) / a;
    if (half < 0.0) return {};
    inside = {true, middle - std::sqrt(half), middle + std::sqrt(half)};
  } else if (beside.norm() > capsule.radius) {
    return {};
  }
  const double begin = offset.dot(axis);
  if (std::abs(along) > parallel) {
    const double first = -begin / along;
    const double last = (length - begin) / along;
    inside.enter = std::max(inside.enter, std::min(first, last));
    inside.leave = std::min(inside.leave, std::max(first, last));
  } else if (begin < 0.0 || begin > length) {
    return {};
  }
  inside.hits = inside.enter <= inside.leave;
  return inside.hits ? inside : LinePassage();
}

/// The outward normal of a plane that has all points of a hull on one side; zero where it has not.
Eigen::Vector3d supporting_normal(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& at,
                                  Eigen::Vector3d normal) {
  constexpr double slack = 1e-9;  // [m]
  if (normal.norm() < parallel) return Eigen::Vector3d::Zero();
  normal.normalize();
  const auto above = [&](double sign) {
    return std::any_of(points.begin(), points.end(),
                       [&](const Eigen::Vector3d& p) { return sign * normal.dot(p - at) > slack; });
  };
  if (!above(1.0)) return normal;
  if (!above(-1.0)) return -normal;
  return Eigen::Vector3d::Zero();
}

}  // namespace

Outline::Outline(const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    std::visit([this](const auto& form) { add(form); }, shape);
  }
}

void Outline::add(const Sphere& sphere) {
  rounds_.push_back({.begin = sphere.centre, .end = sphere.centre, .radius = sphere.radius});
}

void Outline::add(const Capsule& capsule) { rounds_.push_back(capsule); }

void Outline::add(const Box& box) {
  Polytope polytope;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d normal = side * box.axes.col(axis);
      polytope.faces.push_back({normal, normal.dot(box.centre) + box.half_lengths[axis]});
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sides((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                (corner & 4) != 0 ? 1 : -1);
    polytope.corners.emplace_back(box.centre + box.axes * sides.cwiseProduct(box.half_lengths));
  }
  polytopes_.push_back(std::move(polytope));
}

void Outline::add(const ConvexHull& hull) {
  Polytope polytope{.faces = {}, .corners = hull.points, .margin = hull.margin};
  const std::vector<Eigen::Vector3d>& p = hull.points;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      for (std::size_t k = j + 1; k < p.size(); ++k) {
        const Eigen::Vector3d normal = supporting_normal(p, p[i], (p[j] - p[i]).cross(p[k] - p[i]));
        const double offset = normal.dot(p[i]) + hull.margin;
        const bool known =
            std::any_of(polytope.faces.begin(), polytope.faces.end(), [&](const HalfSpace& face) {
              return (face.normal - normal).norm() < 1e-9 && std::abs(face.offset - offset) < 1e-9;
            });
        if (!normal.isZero() && !known) polytope.faces.push_back({normal, offset});
      }
    }
  }
  polytopes_.push_back(std::move(polytope));
}

LinePassage Outline::through(const Round& round, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& direction) {
  const LinePassage ends = joined(through_sphere(round.begin, round.radius, point, direction),
                                  through_sphere(round.end, round.radius, point, direction));
  return joined(ends, through_cylinder(round, point, direction));
}

LinePassage Outline::through(const Polytope& polytope, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& direction) {
  LinePassage inside{!polytope.faces.empty(), -infinite, infinite};
  for (const HalfSpace& face : polytope.faces) {
    const double nearing = face.normal.dot(direction);
    const double room = face.offset - face.normal.dot(point);
    if (std::abs(nearing) <= parallel) {
      if (room < 0.0) return {};
    } else if (nearing > 0.0) {
      inside.leave = std::min(inside.leave, room / nearing);
    } else {
      inside.enter = std::max(inside.enter, room / nearing);
    }
  }
  return inside.hits && inside.enter <= inside.leave ? inside : LinePassage();
}

LinePassage Outline::passage(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const noexcept {
  LinePassage passage;
  for (const Round& round : rounds_) passage = joined(passage, through(round, point, direction));
  for (const Polytope& polytope : polytopes_) passage = joined(passage, through(polytope, point, direction));
  return passage;
}

Eigen::Vector3d Outline::normal_at(const Eigen::Vector3d& point) const noexcept {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double nearest = infinite;
  const auto see = [&](double distance, const Eigen::Vector3d& direction) {
    if (std::abs(distance) >= nearest) return;
    nearest = std::abs(distance);
    normal = direction;
  };
  for (const Round& round : rounds_) {
    const Eigen::Vector3d axis = round.end - round.begin;
    const double length = axis.squaredNorm();
    const double fraction =
        length > 0.0 ? std::clamp((point - round.begin).dot(axis) / length, 0.0, 1.0) : 0.0;
    const Eigen::Vector3d out = point - round.begin - fraction * axis;
    if (out.norm() > 0.0) see(out.norm() - round.radius, out.normalized());
  }
  for (const Polytope& polytope : polytopes_) {
    double highest = -infinite;
    Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
    for (const HalfSpace& face : polytope.faces) {
      const double height = face.normal.dot(point) - face.offset;
      if (height > highest) outwards = face.normal;
      highest = std::max(highest, height);
    }
    see(highest, outwards);
  }
  return normal;
}

Eigen::Vector3d Outline::farthest(const Eigen::Vector3d& direction) const noexcept {
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double reach = -infinite;
  const auto see = [&](const Eigen::Vector3d& point) {
    if (point.dot(direction) <= reach) return;
    reach = point.dot(direction);
    best = point;
  };
  for (const Round& round : rounds_) {
    see(round.begin + round.radius * direction);
    see(round.end + round.radius * direction);
  }
  for (const Polytope& polytope : polytopes_) {
    for (const Eigen::Vector3d& corner : polytope.corners) see(corner + polytope.margin * direction);
  }
  return best;
}

}  // namespace flinch
