#pragma once

#include <filesystem>
#include <vector>

namespace flinch {

struct RunResult;

/// Writes the table of a campaign to results.csv and results.h5 in `folder`. Throws SetupError when that
/// fails.
void write_results(const std::vector<RunResult>& results, const std::filesystem::path& folder);

}  // namespace flinch
