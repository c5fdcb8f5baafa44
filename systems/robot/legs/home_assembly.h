#pragma once

#include <string>
#include <vector>

#include "systems/robot/legs/legs_model.h"

namespace flinch {

/// Assembles `model`, which is sound but for that, at home: finds closed forms, the way of assembly that is
/// nearest to the references, which stand in the `home` of the legs, and what is 1 there. Returns what keeps
/// such a robot from being assembled, driven or moved as it is said to, each as one sentence that begins with
/// the field.
std::vector<std::string> assemble_at_home(const LegsParameters& parameters, LegsModel& model);

/// The pose at home.
Configuration home_configuration(const LegsModel& model);

}  // namespace flinch
