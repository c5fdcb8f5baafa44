#pragma once

#include <Eigen/Core>

#include "systems/framework/time.h"

namespace flinch {

/// A pull by hand at a rope that is tied to a point of a body: a force that keeps its direction in the base
/// frame while it grows linearly, stays and falls back.
struct RopePull {
  int body = 0;                                  ///< BodyId::index()
  Eigen::Vector3d point_in_body{0.0, 0.0, 0.0};  ///< [m]
  Eigen::Vector3d peak_in_base{0.0, 0.0, 0.0};   ///< [N]
  Time start{};
  Time rise = 400ms;
  Time hold = 400ms;
  Time fall = 400ms;

  /// The force on the body at the time `t` [s].
  Eigen::Vector3d at(double t) const noexcept;
};

}  // namespace flinch
