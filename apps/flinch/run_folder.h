#pragma once

#include <filesystem>

#include "apps/flinch/command_line.h"

namespace flinch {

struct Recording;
struct Scenario;

/// Where a run leaves its results: `--out`, or out/`name`. Throws SetupError where the folder cannot be made.
std::filesystem::path make_run_folder(const RunOptions& options, const std::string& name);

/// Judges what was recorded, writes recording and report into `folder`, prints the verdict and returns the
/// exit status. `wall`: how long the run took [s]. Throws SetupError where a file cannot be written.
ExitStatus conclude_run(const Scenario& scenario, const Recording& recording, double wall,
                        const std::filesystem::path& folder, const CommonOptions& common);

}  // namespace flinch
