#pragma once

#include <Eigen/Core>

#include "systems/framework/time.h"

namespace flinch {

/// Where the force-torque instrument sits while ropes are pulled: on one body of the robot after the other.
struct InstrumentMounting {
  int body = 0;                                     ///< BodyId::index()
  Eigen::Vector3d position_in_body{0.0, 0.0, 0.0};  ///< Of its origin, where the rope is tied [m].
  Time start{};                                     ///< It sits there until the next mounting.
  Time slack = 500ms;                               ///< For so long from the start on nothing pulls at it.
};

}  // namespace flinch
