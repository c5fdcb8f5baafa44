#pragma once

#include <Eigen/Core>
#include <array>

#include "systems/robot/body_id.h"
#include "systems/robot/planar_leg.h"

namespace flinch {

/// Motion of a planar 3-RRR at one instant, in fixed-size values for the inner loop of a simulation.
/// Base frame, m, rad, s.
struct PlanarMotion {
  Eigen::Vector3d pose;      ///< (x, y, phi)
  Eigen::Vector3d velocity;  ///< Its time derivative.
  std::array<PlanarLegMotion, 3> legs;
  bool reachable = false;  ///< Otherwise `legs` means nothing.
};

/// Velocity of the material point of `body` that is now at `point` [m/s]. Needs a reachable motion.
Eigen::Vector2d point_velocity(const PlanarMotion& motion, BodyId body,
                               const Eigen::Vector2d& point) noexcept;

/// Platform wrench (f_x, f_y, m_z) of a `force` [N] that acts on `body` at `point`. Needs a reachable motion.
Eigen::Vector3d contact_wrench(const PlanarMotion& motion, BodyId body, const Eigen::Vector2d& point,
                               const Eigen::Vector2d& force) noexcept;

}  // namespace flinch
