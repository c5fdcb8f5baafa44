#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {

/// Names of the entries of WorkspaceLimits as robot files have them, without units.
std::vector<std::string> limit_names(const ParallelRobot& robot);

/// A robot at rest at a pose.
struct WorkspacePose {
  bool reachable = false;  ///< Otherwise nothing below means anything.
  /// det A has the other sign than at home: no way leads there but through a type-II singularity.
  bool beyond_singularity = false;
  std::vector<bool> breaks;  ///< Of each of limit_names().
  double sigma_kappa = 0.0;
  double self_collision_distance = 0.0;  ///< [m]
  JointVector drives;                    ///< [rad or m]

  bool is_within() const;
};

/// Looks at poses of a robot, which outlives it, as do its limits.
class PoseCheck {
 public:
  PoseCheck(const ParallelRobot& robot, const WorkspaceLimits& limits);

  WorkspacePose at(const Configuration& pose) const;

 private:
  const ParallelRobot& robot_;
  const WorkspaceLimits& limits_;
  double home_determinant_ = 0.0;  ///< det A.
};

/// Where a robot can be with the orientation that it has at home, and what its limits leave of that.
struct RobotWorkspace {
  /// The first singularity on straight ways from home.
  struct Singularity {
    CartesianVector direction;  ///< Of length 1.
    double distance = 0.0;      ///< [m]
  };

  std::vector<std::array<double, 2>> reach;  ///< Of each translation: least and largest [m].
  std::size_t poses = 0;                     ///< Looked at and reachable, evenly spread.
  std::size_t beyond_singularity = 0;
  std::vector<std::size_t> breaking;  ///< Poses, not beyond a singularity, that break each of limit_names().
  std::vector<double> sigma_kappa;    ///< Of the poses within the limits, ascending.
  std::vector<double> self_collision_distance;  ///< Of the same, ascending [m].
  std::array<double, 2> drives{};               ///< Least and largest position of a drive in them [rad or m].
  std::optional<Singularity> nearest_singularity;

  std::size_t within() const { return sigma_kappa.size(); }
};
RobotWorkspace robot_workspace(const ParallelRobot& robot, const WorkspaceLimits& limits);

}  // namespace flinch
