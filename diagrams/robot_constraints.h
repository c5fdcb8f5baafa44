#pragma once

#include "systems/motion/constraint_settings.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {

/// The constraints with which a robot begins: those of [SafePR] where it is inside their activation values at
/// home, else (derived)
///
///   sigma_kappa  activation at 1.5, safety at 1.9 times that at home, as at the rig
///   sigma_sc     activation half-way, safety three quarters of the way from that at home to where links
///                touch: to the distance that `limits` names, or at which the two thickest links touch that
///                may meet, if that is more; where home is no farther, to half of that at home
ConstraintSettings constraints_for(const ParallelRobot& robot, const WorkspaceLimits& limits);

}  // namespace flinch
