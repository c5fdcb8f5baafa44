#pragma once

#include "plant/narrow_phase.h"
#include "systems/robot/mechanism.h"

namespace flinch {

/// Where the frame of a body of `robot` is; at the origin for unreachable kinematics. A planar body lies in
/// the plane z = 0.
Placement body_placement(const Mechanism& robot, const Kinematics& now, BodyId body) noexcept;

}  // namespace flinch
