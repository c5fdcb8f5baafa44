#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/log_mapping.h"

namespace flinch {

/// A mapping that a log and a robot suggest.
struct MappingGuess {
  LogMapping mapping;
  std::vector<std::string> units;      ///< of each mapped column, as a mapping file has them
  std::vector<std::string> reasons;    ///< one sentence each
  std::vector<std::string> questions;  ///< what the log does not tell, likewise
  std::string clock_unit = "s";
};

/// Guesses by names, units, ranges, and whether the robot can stand as the columns say. Throws SetupError
/// where time or positions of the drives cannot be found.
MappingGuess guess_mapping(const std::filesystem::path& log, const std::filesystem::path& robot);

}  // namespace flinch
