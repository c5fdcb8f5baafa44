#pragma once

#include <string>
#include <vector>

#include "experiments/recorded/judged_log.h"

namespace flinch {

/// Stretches of a log as --free takes them, "0..1.3" [s]. Throws SetupError for what is none.
std::vector<LogTruth::Stretch> stretches_of(const std::vector<std::string>& texts);

}  // namespace flinch
