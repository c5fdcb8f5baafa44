#pragma once

#include <cstdint>

#include "learning/data_set.h"

namespace flinch::test {

/// Contacts of the robot of the bench without a simulation: a force of 30 to 80 N on a body against which it
/// moves, felt as the exact wrench of its contact Jacobian with a little noise, that has grown by 3/10 of it
/// in each of the last two steps. Each is a run of its own; poses are near to one another.
DataSet contact_examples(int count, std::uint64_t seed);

}  // namespace flinch::test
