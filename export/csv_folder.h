#pragma once

#include <filesystem>
#include <vector>

#include "export/exported_signal.h"

namespace flinch {

/// Writes signals into `folder`, which is made: a table SIGNAL.csv for each, with a column time_s and one for
/// each number, "active_1 [rad]"; and signals.json, see description_json(). Numbers are written so that
/// reading them gives the same bits; a number that a sample does not have is empty, NaN is "nan". Several
/// signals are written at once. Throws SetupError where a file cannot be written.
void write_csv_folder(const Recording& recording, const std::vector<ExportedSignal>& signals,
                      const std::filesystem::path& folder);

}  // namespace flinch
