#pragma once

#include <cstdint>

#include "learning/data_set.h"

namespace flinch::test {

/// Contacts of the robot of the bench without a simulation: a force of 30 to 80 N on a body against which it
/// moves, or two in a leg that closes by 0.25 m/s or more, felt as the exact wrench of its contact Jacobian
/// with a little noise. It has grown evenly for 15 ms; of the two, that on the first link for 25 ms. Each is
/// a run of its own; poses are near to one another.
DataSet contact_examples(int count, std::uint64_t seed);

}  // namespace flinch::test
