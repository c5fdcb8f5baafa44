#pragma once

#include <string>
#include <vector>

#include "diagrams/requested_fault.h"

namespace flinch {

/// Adds what the options --fault ask for. Throws SetupError with all that is wrong with them.
void add_faults(const std::vector<std::string>& options, const ParallelRobot& robot,
                std::vector<RequestedFault>& faults);

}  // namespace flinch
