#include "systems/contact/touch_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "systems/robot/outline.h"

namespace flinch {
namespace {

constexpr int rays = 3000;            // from the middle of each shape
constexpr double edge_length = 0.05;  // places at a right angle to one another count as so far apart [m]

Eigen::Vector3d middle_of(const Sphere& sphere) { return sphere.centre; }
Eigen::Vector3d middle_of(const Capsule& capsule) { return 0.5 * (capsule.begin + capsule.end); }
Eigen::Vector3d middle_of(const Box& box) { return box.centre; }
Eigen::Vector3d middle_of(const ConvexHull& hull) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : hull.points) sum += point;
  return sum / std::max<double>(1.0, static_cast<double>(hull.points.size()));
}

/// A place and the area that its ray stands for [m^2].
struct Candidate {
  TouchPlace place;
  double area = 0.0;
};

bool is_inside(const Outline& outline, const Eigen::Vector3d& point) {
  const LinePassage passage = outline.passage(point, Eigen::Vector3d::UnitX());
  return passage.hits && passage.enter < 0.0 && passage.leave > 0.0;
}

void add_candidates(const std::vector<Outline>& outlines, std::size_t shape, const Eigen::Vector3d& middle,
                    std::vector<Candidate>& all) {
  const double solid_angle = 4.0 * std::numbers::pi / rays;
  for (const Eigen::Vector3d& direction : even_directions(3, rays)) {
    const LinePassage passage = outlines[shape].passage(middle, direction);
    if (!passage.hits || passage.leave <= 0.0) continue;
    const Eigen::Vector3d point = middle + passage.leave * direction;
    const Eigen::Vector3d normal = outlines[shape].normal_at(point);
    const double facing = normal.dot(direction);
    if (facing < 1e-3) continue;
    bool is_hidden = false;
    for (std::size_t i = 0; i < outlines.size(); ++i)
      is_hidden = is_hidden || (i != shape && is_inside(outlines[i], point));
    if (is_hidden) continue;
    all.push_back({{point, normal}, passage.leave * passage.leave * solid_angle / facing});
  }
}

double distance_squared(const TouchPlace& a, const TouchPlace& b) {
  return (a.point - b.point).squaredNorm() +
         0.5 * edge_length * edge_length * (a.normal - b.normal).squaredNorm();
}

}  // namespace

std::vector<Eigen::Vector3d> even_directions(int dimension, int count) {
  std::vector<Eigen::Vector3d> all;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = dimension == 2 ? 0.0 : 1.0 - 2.0 * (i + 0.5) / count;
    const double angle = dimension == 2 ? 2.0 * std::numbers::pi * i / count : golden * i;
    const double r = std::sqrt(1.0 - z * z);
    all.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return all;
}

std::vector<TouchPlace> places_along(const Capsule& capsule, const Eigen::Vector3d& normal, int count) {
  std::vector<TouchPlace> places;
  for (int i = 0; i < count; ++i) {
    const double fraction = (i + 0.5) / count;
    const Eigen::Vector3d point = capsule.begin + fraction * (capsule.end - capsule.begin);
    places.push_back({point + capsule.radius * normal, normal, fraction});
  }
  return places;
}

std::vector<TouchPlace> places_around(const Shape& shape, int dimension, int count) {
  std::vector<TouchPlace> places;
  const Outline outline({shape});
  for (const Eigen::Vector3d& direction : even_directions(dimension, count)) {
    const LinePassage passage = outline.passage(Eigen::Vector3d::Zero(), direction);
    if (!passage.hits) continue;
    const Eigen::Vector3d point = passage.leave * direction;
    places.push_back({point, outline.normal_at(point)});
  }
  return places;
}

// Of many places the one that is farthest from those taken so far is the next.
OutlinePlaces places_by_area(const std::vector<Shape>& shapes, int count) {
  std::vector<Outline> outlines;
  for (const Shape& shape : shapes) outlines.emplace_back(std::vector<Shape>{shape});
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Eigen::Vector3d middle = std::visit([](const auto& form) { return middle_of(form); }, shapes[i]);
    add_candidates(outlines, i, middle, all);
  }
  OutlinePlaces found;
  std::vector<double> distance(all.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> nearest(all.size(), 0);
  while (found.places.size() < std::min(static_cast<std::size_t>(count), all.size())) {
    const auto farthest = std::max_element(distance.begin(), distance.end()) - distance.begin();
    const TouchPlace taken = all[static_cast<std::size_t>(farthest)].place;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double apart = distance_squared(all[i].place, taken);
      if (apart >= distance[i]) continue;
      distance[i] = apart;
      nearest[i] = found.places.size();
    }
    found.places.push_back(taken);
  }
  if (found.places.empty()) return found;
  double area = 0.0;
  for (const Candidate& each : all) area += each.area;
  found.area_each = area / static_cast<double>(found.places.size());
  for (TouchPlace& place : found.places) place.share = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i)
    found.places[nearest[i]].share += all[i].area / found.area_each;
  return found;
}

}  // namespace flinch
