#pragma once

#include <vector>

#include "diagrams/requested_fault.h"

namespace flinch {

class ConfigReader;

/// Reads the list `faults` of a scenario: faults to inject, each from a time on.
std::vector<RequestedFault> read_faults(ConfigReader& file, const ParallelRobot& robot);

}  // namespace flinch
