#include "experiments/robot_check/robot_workspace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/robot/link_segments.h"

namespace flinch {
namespace {

constexpr int steps_over_size = 100;  // of a ray
constexpr int patience = 5;           // steps that are out of reach, after which a ray ends
constexpr double farthest = 5.0;      // of a robot's size
constexpr double beside = 0.15;       // of the reach along rays: what is looked at beyond it
constexpr int planar_points = 61;     // along each axis
constexpr int spatial_points = 25;

Configuration moved(const ParallelRobot& robot, const CartesianVector& by) {
  PlatformVector away = PlatformVector::Zero(robot.dof());
  away.head(by.size()) = by;
  return robot.space().plus(robot.home_pose(), away);
}

/// Largest distance of a joint from the platform at home [m].
double size_of(const ParallelRobot& robot) {
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  double size = 0.0;
  for (int leg = 0; leg < robot.legs(); ++leg) {
    const CartesianVector& base = home.legs[static_cast<std::size_t>(leg)].base_joint;
    size = std::max(
        size, (base.head(robot.space().translations()) - robot.home_pose().head(robot.space().translations()))
                  .norm());
  }
  return size;
}

/// All directions along axes and between them.
std::vector<CartesianVector> directions(int translations) {
  std::vector<CartesianVector> all;
  const int count = translations == 2 ? 9 : 27;
  for (int number = 0; number < count; ++number) {
    CartesianVector direction(translations);
    for (int axis = 0, rest = number; axis < translations; ++axis, rest /= 3) direction[axis] = rest % 3 - 1;
    if (direction.norm() > 0.0) all.push_back(direction.normalized());
  }
  return all;
}

void widen(const CartesianVector& reached, RobotWorkspace& found) {
  for (std::size_t axis = 0; axis < found.reach.size(); ++axis) {
    auto& [low, high] = found.reach[axis];
    low = std::min(low, reached[static_cast<Eigen::Index>(axis)]);
    high = std::max(high, reached[static_cast<Eigen::Index>(axis)]);
  }
}

/// Follows straight ways from home, as long as they are in reach.
void follow_rays(const ParallelRobot& robot, const PoseCheck& check, RobotWorkspace& found) {
  const int translations = robot.space().translations();
  const CartesianVector home = robot.home_pose().head(translations);
  const double size = size_of(robot), step = size / steps_over_size;
  for (int axis = 0; axis < translations; ++axis) found.reach.push_back({home[axis], home[axis]});
  for (const CartesianVector& direction : directions(translations)) {
    bool is_before_singularity = true;
    int missed = 0;
    for (double way = step; way < farthest * size && missed < patience; way += step) {
      const CartesianVector by = way * direction;
      const WorkspacePose there = check.at(moved(robot, by));
      missed = there.reachable ? 0 : missed + 1;
      if (!there.reachable) continue;
      widen(home + by, found);
      if (!there.beyond_singularity || !is_before_singularity) continue;
      is_before_singularity = false;
      if (!found.nearest_singularity || way < found.nearest_singularity->distance)
        found.nearest_singularity = {direction, way};
    }
  }
}

void count(const WorkspacePose& pose, RobotWorkspace& found) {
  if (!pose.reachable) return;
  ++found.poses;
  if (pose.beyond_singularity) {
    ++found.beyond_singularity;
    return;
  }
  for (std::size_t i = 0; i < pose.breaks.size(); ++i) found.breaking[i] += pose.breaks[i] ? 1U : 0U;
  if (!pose.is_within()) return;
  found.sigma_kappa.push_back(pose.sigma_kappa);
  found.self_collision_distance.push_back(pose.self_collision_distance);
  found.drives[0] = std::min(found.drives[0], pose.drives.minCoeff());
  found.drives[1] = std::max(found.drives[1], pose.drives.maxCoeff());
}

}  // namespace

std::vector<std::string> limit_names(const ParallelRobot& robot) {
  const std::string drives = robot.drive_kind(0) == DriveKind::revolute ? "angle" : "length";
  return {"max_distance",
          "max_rotation",
          "min_abs_det_A",
          "min_abs_det_B",
          "min_self_collision_distance",
          "min_platform_gap",
          "min_active_" + drives,
          "max_active_" + drives};
}

bool WorkspacePose::is_within() const {
  return reachable && !beyond_singularity &&
         std::none_of(breaks.begin(), breaks.end(), [](bool one) { return one; });
}

PoseCheck::PoseCheck(const ParallelRobot& robot, const WorkspaceLimits& limits)
    : robot_(robot), limits_(limits) {
  Kinematics home;
  robot.kinematics(robot.home_pose(), PlatformVector::Zero(robot.dof()), home);
  home_determinant_ = home.det_A;
}

WorkspacePose PoseCheck::at(const Configuration& pose) const {
  Kinematics at;
  robot_.kinematics(pose, PlatformVector::Zero(robot_.dof()), at);
  WorkspacePose result;
  result.reachable = at.valid;
  if (!at.valid) return result;
  result.beyond_singularity = at.det_A * home_determinant_ <= 0.0;
  result.sigma_kappa = at.sigma_kappa;
  result.self_collision_distance = self_collision_distance(robot_, at);
  result.drives = at.joints.active;
  result.breaks = {
      distance_from_centre(limits_, robot_, pose) > limits_.max_distance,
      robot_.space().rotation_angle(pose) > limits_.max_rotation, std::abs(at.det_A) < limits_.min_abs_det_A,
      std::abs(at.det_B) < limits_.min_abs_det_B,
      result
          .self_collision_distance<limits_.min_self_collision_distance,
                                   robot_.platform_gap(at) < limits_.min_platform_gap,
                                   result.drives.minCoeff() < limits_.min_active, result.drives.maxCoeff()>
              limits_.max_active};
  return result;
}

RobotWorkspace robot_workspace(const ParallelRobot& robot, const WorkspaceLimits& limits) {
  RobotWorkspace found;
  found.breaking.assign(limit_names(robot).size(), 0);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  found.drives = {infinite, -infinite};
  const PoseCheck check(robot, limits);
  follow_rays(robot, check, found);
  const int translations = robot.space().translations();
  const CartesianVector home = robot.home_pose().head(translations);
  const auto along_rays = found.reach;
  const int points = translations == 2 ? planar_points : spatial_points;
  std::size_t all = 1;
  for (int axis = 0; axis < translations; ++axis) all *= static_cast<std::size_t>(points);
  for (std::size_t number = 0; number < all; ++number) {
    CartesianVector by(translations);
    std::size_t rest = number;
    for (int axis = 0; axis < translations; ++axis, rest /= static_cast<std::size_t>(points)) {
      const auto& [low, high] = along_rays[static_cast<std::size_t>(axis)];
      const double place = static_cast<double>(rest % static_cast<std::size_t>(points)) / (points - 1);
      by[axis] = low + (high - low) * ((1.0 + 2.0 * beside) * place - beside) - home[axis];
    }
    const WorkspacePose there = check.at(moved(robot, by));
    if (there.reachable) widen(home + by, found);
    count(there, found);
  }
  std::sort(found.sigma_kappa.begin(), found.sigma_kappa.end());
  std::sort(found.self_collision_distance.begin(), found.self_collision_distance.end());
  return found;
}

}  // namespace flinch
