#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch {

/// What `make` returns; what is wrong is told with the name of `file`, where it comes from.
template <class Make>
auto out_of(const std::filesystem::path& file, Make&& make) {
  try {
    return make();
  } catch (const SetupError& error) {
    std::vector<std::string> problems;
    for (const std::string& problem : error.problems()) problems.push_back(file.string() + ": " + problem);
    throw SetupError(std::move(problems));
  }
}

}  // namespace flinch
