#pragma once

#include <string>
#include <vector>

#include "tests/fault/lies/lie_trial.h"

namespace flinch::test {

/// The lies that are tried of each drive, and of all sensors of a kind together.
std::vector<std::string> lies_of_a_drive(int number);
std::vector<std::string> lies_of_all();

}  // namespace flinch::test
