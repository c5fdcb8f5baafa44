#include "plant/obstacle.h"

#include "plant/setting_problems.h"

namespace flinch {
namespace {

void check(const Sphere& sphere, const std::string& owner, std::vector<std::string>& found) {
  SettingProblems problems(owner);
  problems.require_positive("radius", sphere.radius);
  problems.append_to(found);
}

void check(const Capsule& capsule, const std::string& owner, std::vector<std::string>& found) {
  SettingProblems problems(owner);
  problems.require_positive("radius", capsule.radius);
  problems.append_to(found);
}

void check(const Box& box, const std::string& owner, std::vector<std::string>& found) {
  SettingProblems problems(owner);
  problems.require_positive("half_lengths", box.half_lengths.minCoeff());
  problems.append_to(found);
}

void check(const ConvexHull& hull, const std::string& owner, std::vector<std::string>& found) {
  SettingProblems problems(owner);
  problems.require_not_negative("margin", hull.margin);
  problems.append_to(found);
  if (hull.points.size() < 4) {
    found.push_back(owner + "points has " + std::to_string(hull.points.size()) +
                    " entries; a hull needs at least 4");
  }
}

}  // namespace

std::vector<std::string> Obstacle::problems(const std::string& owner) const {
  std::vector<std::string> found;
  std::visit([&](const auto& shape) { check(shape, owner, found); }, form_.shape);
  if (!form_.position_in_base.allFinite()) found.push_back(owner + "position must be finite");
  find_problems(owner, found);
  for (std::string& problem : flinch::problems(form_.material, owner + "material.")) {
    found.push_back(std::move(problem));
  }
  return found;
}

void Obstacle::find_problems(const std::string&, std::vector<std::string>&) const {}

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
