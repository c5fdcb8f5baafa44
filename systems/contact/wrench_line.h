#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "systems/robot/line_of_action.h"

namespace flinch {

/// The line along which a force acts that alone makes a wrench in space, in the frame of the platform, and
/// how far beside it the force may act by the noise of the moment.
struct WrenchLine {
  static constexpr double deviations = 3.0;

  Eigen::Vector3d point, direction;       ///< a point on it [m]; of the force on the robot
  std::array<Eigen::Vector3d, 2> across;  ///< square to it and to one another
  double reach = 0.0;  ///< so far it may be either way along both of these [m]; infinite without a force

  /// `wrench`: of a platform that turns about all axes, with its `covariance`; `axes`: of the platform in the
  /// base frame.
  WrenchLine(const ConfigurationSpace& space, const PlatformVector& wrench, const PlatformMatrix& covariance,
             const Eigen::Matrix3d& axes) {
    const LineOfAction line = line_of_action(space, wrench, 0.0);
    direction = axes.transpose() * line.direction;
    point = axes.transpose() * line.lever;
    across[0] = direction.unitOrthogonal();
    across[1] = direction.cross(across[0]);
    reach =
        deviations * std::sqrt(covariance.bottomRightCorner<3, 3>().trace() / 3.0) / wrench.head<3>().norm();
  }

  /// Whether it may pass through a place.
  bool passes(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d beside = place - point;
    return std::abs(beside.dot(across[0])) < reach && std::abs(beside.dot(across[1])) < reach;
  }
};

}  // namespace flinch
