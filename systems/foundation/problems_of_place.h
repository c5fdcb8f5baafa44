#pragma once

#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch {

/// What `make` returns; what is wrong is told with where it comes from: a file, a bus.
template <class Make>
auto out_of(const std::string& place, Make&& make) {
  try {
    return make();
  } catch (const SetupError& error) {
    std::vector<std::string> problems;
    for (const std::string& problem : error.problems()) problems.push_back(place + ": " + problem);
    throw SetupError(std::move(problems));
  }
}

}  // namespace flinch
