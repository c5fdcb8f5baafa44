#include "experiments/speed_limit/workspace_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {
namespace {

/// Whether the robot may be at (x, y), at the height and orientation of a pose.
class AllowedPlaces {
 public:
  AllowedPlaces(const ParallelRobot& robot, const WorkspaceLimits& limits, Configuration pose)
      : robot_(robot), limits_(limits), pose_(std::move(pose)) {}

  bool operator()(const Eigen::Vector2d& place) const {
    Configuration pose = pose_;
    pose.head<2>() = place;
    Kinematics there;
    robot_.kinematics(pose, PlatformVector::Zero(robot_.dof()), there);
    return is_within(limits_, robot_, there);
  }

 private:
  const ParallelRobot& robot_;
  const WorkspaceLimits& limits_;
  Configuration pose_;
};

/// How large the robot is: from the pose to the furthest foot of a leg [m].
double size_of(const ParallelRobot& robot, const Configuration& pose) {
  Kinematics there;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), there);
  double size = 0.0;
  for (int i = 0; i < robot.legs(); ++i) {
    const CartesianVector& foot = there.legs[static_cast<std::size_t>(i)].base_joint;
    size = std::max(size, (foot - CartesianVector(pose.head(robot.space_dimension()))).norm());
  }
  return size;
}

struct Extent {
  Eigen::Vector2d least, most;
};

/// What is reached from `start` by steps along the axes that stay in allowed places.
Extent reached_from(const Eigen::Vector2d& start, const AllowedPlaces& is_allowed, double size) {
  constexpr int steps = 50;  // along the size of the robot
  using Node = std::pair<int, int>;
  std::set<Node> seen = {{0, 0}};
  std::vector<Node> open = {{0, 0}};
  Extent extent{start, start};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    const Eigen::Vector2d place = start + size / steps * Eigen::Vector2d(i, k);
    extent.least = extent.least.cwiseMin(place);
    extent.most = extent.most.cwiseMax(place);
    for (const auto& [di, dk] : std::array<Node, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
      const Node next{i + di, k + dk};
      if (std::max(std::abs(next.first), std::abs(next.second)) > 2 * steps) continue;
      if (!is_allowed(start + size / steps * Eigen::Vector2d(next.first, next.second))) continue;
      if (seen.insert(next).second) open.push_back(next);
    }
  }
  return extent;
}

Eigen::Vector2d in_whole_mm(const Eigen::Vector2d& place) {
  return (1e3 * place).array().round().matrix() / 1e3;
}

}  // namespace

std::vector<Eigen::Vector2d> workspace_grid(const ParallelRobot& robot, const WorkspaceLimits& limits,
                                            const Configuration& pose, int count) {
  const AllowedPlaces is_allowed(robot, limits, pose);
  const Eigen::Vector2d start = pose.head<2>();
  if (!is_allowed(start)) {
    throw SetupError(
        "motion.pose: is not within the workspace limits of the robot file, so that no grid can be laid "
        "about "
        "it; give a pose within them, or places with --at");
  }
  const Extent extent = reached_from(start, is_allowed, size_of(robot, pose));
  const Eigen::Vector2d sides = extent.most - extent.least, middle = 0.5 * (extent.least + extent.most);
  const double spacing = std::max(sides.maxCoeff() / count, 1e-3);
  const Eigen::Array2i counts = (sides.array() / spacing + 1e-9).floor().cast<int>().max(1);
  std::vector<Eigen::Vector2d> places;
  for (int k = 0; k < counts.y(); ++k) {
    for (int i = 0; i < counts.x(); ++i) {
      const Eigen::Vector2d from_middle(i - 0.5 * (counts.x() - 1), k - 0.5 * (counts.y() - 1));
      const Eigen::Vector2d place = in_whole_mm(middle + spacing * from_middle);
      if (is_allowed(place)) places.push_back(place);
    }
  }
  return places;
}

}  // namespace flinch
