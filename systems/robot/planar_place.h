#pragma once

#include "systems/robot/mechanism.h"
#include "systems/robot/place_kinematics.h"

namespace flinch {

/// The place of a planar 3-RRR at `pose`, without the rest of its kinematics, and the same to the bit. False
/// for other mechanisms.
bool evaluate_planar_place(const Mechanism& mechanism, const Configuration& pose,
                           PlaceKinematics& out) noexcept;

}  // namespace flinch
