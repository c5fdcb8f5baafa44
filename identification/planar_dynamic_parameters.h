#pragma once

#include <memory>

#include "identification/dynamic_parameters.h"
#include "systems/robot/five_bar_parameters.h"
#include "systems/robot/planar_rrr_parameters.h"

namespace flinch {

/// Base parameters p1, p2, p3 and friction of each leg, mass and inertia of the platform.
std::unique_ptr<const DynamicParameters> planar_dynamic_parameters(const PlanarRrrParameters& robot);
/// The same of a five-bar, whose platform does not turn.
std::unique_ptr<const DynamicParameters> planar_dynamic_parameters(const FiveBarParameters& robot);

}  // namespace flinch
