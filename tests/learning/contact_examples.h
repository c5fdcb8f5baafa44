#pragma once

#include <cstdint>

#include "learning/data_set.h"

namespace flinch::test {

/// Contacts of the robot of the rig without a simulation: a force of 30 to 80 N on a body, or one on each
/// link of a leg that closes, felt as the exact wrench of its contact Jacobian with a little noise. Each
/// force has grown evenly for 15 to 40 ms; those of a clamping not for equally long. The robot moves at
/// 0.5 m/s, and fast enough against what it touches that objects of up to 100 kN/m can be pressed so hard in
/// that time. Each contact is a run of its own; poses are near to one another.
DataSet contact_examples(int count, std::uint64_t seed);

}  // namespace flinch::test
