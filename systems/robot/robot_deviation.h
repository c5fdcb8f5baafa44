#pragma once

#include <cstddef>
#include <memory>

#include "systems/robot/vectors.h"

namespace flinch {

class Mechanism;

/// How a robot that stands there differs from the one that a controller believes in.
struct RobotDeviation {
  JointVector drive_friction_scale{};    ///< Of each drive; empty: 1.
  JointVector passive_friction_scale{};  ///< Of the passive joints of each leg; empty: 1.
  JointVector leg_inertia_scale{};       ///< Of each leg's masses and moments of inertia; empty: 1.
  double platform_inertia_scale = 1.0;
  double payload = 0.0;  ///< A point mass at the platform's origin [kg].

  /// Whether there is none.
  bool none() const;
};

/// Of drive or leg `i`; 1 where none is given.
double scale_of(const JointVector& scales, std::size_t i);

/// `robot` with these differences. Throws SetupError where its kind cannot differ from itself, see
/// Mechanism::deviating(), and there are any.
std::shared_ptr<const Mechanism> true_robot(const std::shared_ptr<const Mechanism>& robot,
                                            const RobotDeviation& deviation);

}  // namespace flinch
