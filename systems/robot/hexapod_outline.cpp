#include "systems/robot/hexapod_outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "systems/robot/rotation.h"

namespace flinch {
namespace {

/// Normals of the twelve sides of the platform.
const std::array<Eigen::Vector2d, 12>& side_normals() {
  static const std::array<Eigen::Vector2d, 12> normals = [] {
    std::array<Eigen::Vector2d, 12> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double angle = (static_cast<double>(i) + 0.5) * std::numbers::pi / 6.0;
      all[i] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return normals;
}

/// Of a point from the platform's outline as seen along its axis; that side is nearest whose normal has most
/// of the point.
double distance_from_sides(double radius, const Eigen::Vector2d& point) {
  static const double apothem = std::cos(std::numbers::pi / 12.0),
                      half_side = std::sin(std::numbers::pi / 12.0);
  double most = 0.0, along = 0.0;
  for (const Eigen::Vector2d& normal : side_normals()) {
    if (normal.dot(point) <= most) continue;
    most = normal.dot(point);
    along = std::abs(normal.x() * point.y() - normal.y() * point.x());
  }
  const double beyond = most - radius * apothem;
  return beyond <= 0.0 ? 0.0 : std::hypot(beyond, std::max(along - radius * half_side, 0.0));
}

/// From E to the base frame.
struct PlatformFrame {
  explicit PlatformFrame(const Configuration& pose)
      : origin(pose.head<3>()), axes(rotation_matrix(Eigen::Vector4d(pose.tail<4>()).normalized())) {}
  Eigen::Vector3d inside(const Eigen::Vector3d& point) const { return axes.transpose() * (point - origin); }

  Eigen::Vector3d origin;
  Eigen::Matrix3d axes;
};

/// Of the segment between two points. The distance from a convex outline is a convex function along it, and
/// never falls on the way from a point within: where the line comes from one, its near end is the nearest.
double least_distance(const HexapodParameters& robot, const Eigen::Vector3d& near, const Eigen::Vector3d& far,
                      const Eigen::Vector3d& joint) {
  if (distance_from_platform(robot, joint) == 0.0) return distance_from_platform(robot, near);
  double low = 0.0, high = 1.0;
  const auto at = [&](double share) { return distance_from_platform(robot, near + share * (far - near)); };
  for (int step = 0; step < 60; ++step) {
    const double third = (high - low) / 3.0;
    const bool nearer = at(low + third) <= at(high - third);
    (nearer ? high : low) += nearer ? -third : third;
  }
  return at(0.5 * (low + high));
}

}  // namespace

double distance_from_platform(const HexapodParameters& robot, const Eigen::Vector3d& point) noexcept {
  const double across = distance_from_sides(robot.platform_radius, point.head<2>());
  const double along = std::max({robot.platform_bottom - point.z(), point.z() - robot.platform_top, 0.0});
  return std::hypot(across, along);
}

std::array<double, 6> held_stretches(const HexapodParameters& robot) noexcept {
  std::array<double, 6> held{};
  const Eigen::Matrix3d axes = rotation_matrix(quaternion_exp(robot.home_rotation));
  for (std::size_t i = 0; i < held.size(); ++i) {
    const Eigen::Vector3d& joint = robot.legs[i].platform_joint;
    if (distance_from_platform(robot, joint) > 0.0) continue;
    const Eigen::Vector3d base = axes.transpose() * (robot.legs[i].base_joint - robot.home_position);
    const Eigen::Vector3d away = (base - joint).normalized();
    double low = 0.0, high = robot.rod_length;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      const bool overlaps = distance_from_platform(robot, joint + middle * away) < robot.rod_radius;
      (overlaps ? low : high) = middle;
    }
    held[i] = std::min(2.0 * high, robot.rod_length);
  }
  return held;
}

double leg_platform_gap(const HexapodParameters& robot, const std::array<double, 6>& held,
                        const Kinematics& kinematics) noexcept {
  const PlatformFrame platform(kinematics.pose);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < held.size(); ++i) {
    const Eigen::Vector3d& joint = robot.legs[i].platform_joint;
    const Eigen::Vector3d base = platform.inside(robot.legs[i].base_joint);
    const Eigen::Vector3d away = (base - joint).normalized();
    const Eigen::Vector3d top = base - robot.cylinder_length * away;  // of the cylinder
    const double rod = least_distance(robot, joint + held[i] * away, joint + robot.rod_length * away, joint);
    least = std::min(
        {least, rod - robot.rod_radius, least_distance(robot, top, base, joint) - robot.cylinder_radius});
  }
  return std::max(least, 0.0);
}

}  // namespace flinch
