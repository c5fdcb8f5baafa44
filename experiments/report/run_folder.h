#pragma once

#include <filesystem>

#include "experiments/verdict/verdict.h"

namespace flinch {

struct Scenario;

/// Makes the folder for what a run leaves, if it is not there. Throws SetupError where that fails.
void make_run_folder(const std::filesystem::path& folder);

/// Judges what was recorded, and leaves recording and report in `folder` as run.h5 and report.html. Throws
/// SetupError where a file cannot be written.
Verdict conclude_run(const Scenario& scenario, const Recording& recording,
                     const std::filesystem::path& folder);

}  // namespace flinch
