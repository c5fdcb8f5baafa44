#pragma once

#include <filesystem>
#include <string>

#include "apps/flinch/command_line.h"
#include "experiments/report/run_folder.h"

namespace flinch {

struct Recording;
struct Scenario;

/// Makes the folder where a run leaves its results: `--out`, or out/`name`. Throws SetupError.
RunFolder folder_of(const RunOptions& options, const std::string& name);

/// Judges the recording in `folder`, leaves a report beside it, prints the verdict and returns the exit
/// status. `wall`: how long the run took [s]. Throws SetupError where a file cannot be read or written.
ExitStatus conclude(const Scenario& scenario, double wall, const std::filesystem::path& folder,
                    const CommonOptions& common);

/// Says where a recording holds only a part of a run.
void tell_if_partial(const Recording& recording, const CommonOptions& common);

/// Whether it is read in less than two seconds.
bool is_short(const Recording& recording);

/// Throws SetupError naming `file`, where the recording comes from, if it holds readings alone.
void require_run(const Recording& recording, const std::filesystem::path& file);

}  // namespace flinch
