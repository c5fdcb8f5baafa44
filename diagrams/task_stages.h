#pragma once

#include <vector>

#include "diagrams/control_stages.h"

namespace flinch {

/// Laws of the nominal motion that serve tasks by priority: "velocity_tracking", "acceleration_tracking",
/// "torque_tracking", after the level of [SafePR] IV-C to IV-E.
std::vector<ControlLaw> tracking_stages();

/// Laws of the reaction that do so: "velocity_reaction", "acceleration_reaction", "torque_reaction".
std::vector<ControlLaw> task_reaction_stages();

}  // namespace flinch
