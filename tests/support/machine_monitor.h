#pragma once

#include <string>

#include "systems/framework/time.h"

namespace flinch::test {

/// How late the machine itself has been since the present test began: the longest that a program which does
/// nothing but wait for the next millisecond was not woken, on any processor. Measured by such programs
/// beside each test of the executable that links this. What a test demands in milliseconds it can demand of a
/// machine that is not later.
///
/// A test that fails while its machine was late says so: not_measured().
Time machine_stall();

/// "not measured: the machine stalled for 3.2 ms".
std::string not_measured();

/// Stalls that matter to a loop of 1 kHz.
constexpr Time noticeable_stall = 1ms;

}  // namespace flinch::test
