#pragma once

#include <string>

#include "systems/robot/five_bar_presets.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/systems/robot/mechanism_cases.h"

namespace flinch::test {

/// Planar robots whose legs differ in inertia, rotors and friction, and their bodies.
MechanismCase planar_rrr_case(const std::string& name, RigGeometry geometry);
MechanismCase five_bar_case(const std::string& name, FiveBarElbows elbows);
MechanismCase point_on_three_legs_case(const std::string& name);

}  // namespace flinch::test
