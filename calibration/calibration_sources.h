#pragma once

#include <filesystem>
#include <vector>

#include "calibration/calibration_result.h"

namespace flinch {

/// The name of a file and the hash of its bytes; of a recording that is not there, of those of its journal.
CalibrationSource source_of(const std::filesystem::path& file);

/// Throws SetupError naming each recording whose bytes one before it holds as well. Counted twice, it would
/// seem to confirm what it says once.
void require_different(const std::vector<CalibrationSource>& recordings);

}  // namespace flinch
