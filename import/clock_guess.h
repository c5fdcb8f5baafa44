#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/log_candidate.h"
#include "import/log_file.h"
#include "import/log_mapping.h"

namespace flinch {

/// The time of a log that its columns suggest.
struct ClockGuess {
  LogClock clock;
  std::string unit = "s";
  std::vector<std::string> reasons;  ///< one sentence each
};

/// The first column that is called a time and grows as one does, or two that do so in sum. `name`: of the
/// log. Throws SetupError where there is none.
ClockGuess guess_clock(LogFile& log, const std::filesystem::path& name,
                       const std::vector<LogCandidate>& candidates);

}  // namespace flinch
