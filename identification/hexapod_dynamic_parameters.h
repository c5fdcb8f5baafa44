#pragma once

#include <memory>

#include "identification/dynamic_parameters.h"
#include "systems/robot/hexapod_parameters.h"

namespace flinch {

/// Friction of each leg, and what is fixed to the platform beyond what the robot says: a payload, by its
/// mass, its first moments and its inertia about the origin of the platform.
std::unique_ptr<const DynamicParameters> hexapod_dynamic_parameters(const HexapodParameters& robot);

}  // namespace flinch
