#pragma once

#include <cstdlib>
#include <sstream>

namespace flinch::test {

/// How much of a long test is wanted: what this variable of the environment says, else what is usual.
template <class T>
T wanted(const char* variable, T usual) {
  if (const char* const given = std::getenv(variable)) std::istringstream(given) >> usual;
  return usual;
}

}  // namespace flinch::test
