#pragma once

#include <cmath>
#include <limits>

#include "systems/robot/motion_barriers.h"

namespace flinch {

/// The shortest straight stop from one motion.
struct StraightStop {
  double duration = std::numeric_limits<double>::infinity();  ///< [s]; infinite: none is possible
  bool stays_inside = false;  ///< it is possible, and the robot stays within its limits on the way

  /// Whether the drives can begin it.
  bool is_possible() const { return std::isfinite(duration); }
};

/// How the robot would stop straight in the space of poses, dv = -v / T, with the smallest T whose begin no
/// drive needs more than `max_torque` for [Nm or N]:
///
///   J_x,qa^T (C_x v + g_x + F_fr,x - M_x v / T) within the torques.
///
/// The way is looked at in ten places. Robots that can stop so are in the braking set of `limits`: who keeps
/// them from there on need not exceed them. Nothing is possible where kinematics or dynamics are not valid.
StraightStop straight_stop(const Mechanism& robot, const Kinematics& at, const Dynamics& dynamics,
                           const PoseConstraints& limits, double max_torque) noexcept;

}  // namespace flinch
