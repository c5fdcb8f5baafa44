#pragma once

#include <vector>

#include "diagrams/control_stages.h"

namespace flinch {

/// Every wrench estimator of flinch, as its settings say, by the name of its section of them. The first is
/// the standard one.
std::vector<WrenchEstimator> estimator_stages();

}  // namespace flinch
