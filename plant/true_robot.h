#pragma once

#include <memory>
#include <string>
#include <vector>

#include "systems/robot/mechanism.h"

namespace flinch {

/// How a robot that stands there differs from the one that a controller believes in.
struct RobotDeviation {
  JointVector drive_friction_scale;    ///< Of each drive; empty: 1.
  JointVector passive_friction_scale;  ///< Of the passive joints of each leg; empty: 1.
  JointVector leg_inertia_scale;       ///< Of each leg's masses and moments of inertia; empty: 1.
  double platform_inertia_scale = 1.0;
  double payload = 0.0;  ///< A point mass at the platform's origin [kg].
};

/// `robot` with these differences. Throws SetupError for a mechanism whose parameters are not known here.
std::shared_ptr<const Mechanism> true_robot(const std::shared_ptr<const Mechanism>& robot,
                                            const RobotDeviation& deviation);

}  // namespace flinch
