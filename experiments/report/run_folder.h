#pragma once

#include <filesystem>

#include "experiments/verdict/verdict.h"

namespace flinch {

struct Recording;
struct Scenario;

/// Makes the folder for what a run leaves, if it is not there. Throws SetupError where that fails.
void make_run_folder(const std::filesystem::path& folder);

/// Where a run leaves its recording.
std::filesystem::path recording_in(const std::filesystem::path& folder);

/// Judges `recording`, which is in `folder`, and leaves report.html beside it. Throws SetupError where a file
/// cannot be read or written.
Verdict report_run(const Scenario& scenario, const Recording& recording, const std::filesystem::path& folder);

/// The same for a recording that is not there yet.
Verdict conclude_run(const Scenario& scenario, const Recording& recording,
                     const std::filesystem::path& folder);

}  // namespace flinch
