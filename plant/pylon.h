#pragma once

#include <Eigen/Core>

#include "plant/hunt_crossley.h"

namespace flinch {

/// What the robot may run into: an upright post with a round outline that reaches through the plane of
/// motion.
struct Pylon {
  enum class Mounting {
    fixed,     ///< Only its surface gives way.
    compliant  ///< It also moves as a mass on a spring and a damper, alike in all directions.
  };

  Eigen::Vector2d position_in_base{0.0, 0.0};  ///< Of its axis while nothing touches it [m].
  double radius = 0.04;                        ///< [m]
  ContactMaterial material;
  Mounting mounting = Mounting::fixed;

  // Of a compliant mounting:
  double mass = 1.0;                ///< [kg]
  double mount_stiffness = 2000.0;  ///< [N/m]
  double mount_damping = 20.0;      ///< [N s/m]
};

/// Position and velocity of the pylon's axis in the base frame [m, m/s].
struct PylonMotion {
  Eigen::Vector2d position{0.0, 0.0};
  Eigen::Vector2d velocity{0.0, 0.0};
};

}  // namespace flinch
