#include "plant/obstacle.h"

#include "systems/foundation/findings.h"
#include "systems/robot/convex_hull.h"

namespace flinch {
namespace {

void check(const Sphere& sphere, Findings& found) { found.positive("radius", sphere.radius, "m"); }

void check(const Capsule& capsule, Findings& found) { found.positive("radius", capsule.radius, "m"); }

void check(const Box& box, Findings& found) {
  found.positive("half_lengths", box.half_lengths.minCoeff(), "m");
}

void check(const ConvexHull& hull, Findings& found) {
  found.not_negative("margin", hull.margin, "m");
  const std::string complaint = complaint_about_points(hull);
  found.require(complaint.empty(), "points " + complaint);
}

}  // namespace

std::vector<std::string> Obstacle::problems(const std::string& owner) const {
  Findings found(owner);
  std::visit([&](const auto& shape) { check(shape, found); }, form_.shape);
  found.require(form_.position_in_base.allFinite(), "position must be finite");
  find_problems(owner, found);
  found.add_all(flinch::problems(form_.material, owner + "material."));
  return found.take();
}

void Obstacle::find_problems(const std::string&, Findings&) const {}

ObstacleMotion Obstacle::motion(double) const noexcept { return {}; }

Eigen::Vector3d Obstacle::acceleration(double, const ObstacleMotion&, const Eigen::Vector3d&) const noexcept {
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d Obstacle::force_on_mount(double, const ObstacleMotion&,
                                         const Eigen::Vector3d& contact_force) const noexcept {
  return contact_force;
}

Eigen::Vector3d Obstacle::grip_force(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
  return Eigen::Vector3d::Zero();
}

}  // namespace flinch
