#pragma once

#include <filesystem>
#include <string>

#include "apps/flinch/command_line.h"

namespace flinch {

struct Recording;
struct Scenario;

/// Makes the folder where a run leaves its results: `--out`, or out/`name`. Throws SetupError.
std::filesystem::path folder_of(const RunOptions& options, const std::string& name);

/// Judges what was recorded, leaves recording and report in `folder`, prints the verdict and returns the exit
/// status. `wall`: how long the run took [s]. Throws SetupError where a file cannot be written.
ExitStatus conclude(const Scenario& scenario, const Recording& recording, double wall,
                    const std::filesystem::path& folder, const CommonOptions& common);

}  // namespace flinch
