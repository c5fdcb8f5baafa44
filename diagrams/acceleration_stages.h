#pragma once

#include <vector>

#include "diagrams/control_stages.h"

namespace flinch {

/// Every source of the platform's acceleration that flinch has, as its settings say.
std::vector<AccelerationSource> acceleration_stages();

}  // namespace flinch
