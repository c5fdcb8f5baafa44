#pragma once

#include <vector>

#include "tests/systems/robot/mechanism_cases.h"

namespace flinch::test {

/// States within the case's region; the same for the same seed.
std::vector<MotionState> random_states(const MechanismCase& mechanism, int count, unsigned seed = 1);

}  // namespace flinch::test
