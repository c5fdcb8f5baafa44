#pragma once

#include <string>

#include "systems/signals/gate_fault.h"

namespace flinch {

/// The fault as the fault table describes it; `otherwise` where it is none.
std::string description_of(GateFault fault, const std::string& otherwise = "");

}  // namespace flinch
