#pragma once

#include <filesystem>
#include <vector>

#include "export/exported_signal.h"

namespace flinch {

/// Writes signals as a file of NumPy: an array for each field, "joints.active", samples x numbers, or samples
/// where it is one number; "time_s"; and the text signals.json, see description_json(). Numbers that a sample
/// does not have are NaN. Throws SetupError where the file cannot be written, or would have more than 4 GB.
void write_npz(const Recording& recording, const std::vector<ExportedSignal>& signals,
               const std::filesystem::path& file);

}  // namespace flinch
