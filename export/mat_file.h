#pragma once

#include <filesystem>
#include <vector>

#include "export/exported_signal.h"

namespace flinch {

/// Writes signals as a file of MATLAB, level 5, compressed, that Octave and SciPy read as well: the variable
/// time_s; for each signal a struct with an array for each field, joints.active, samples x numbers; and
/// units, components and frames, structs of that shape with texts, whose parts ", " joins. Numbers
/// that a sample does not have are NaN. Where a name has other characters than letters and digits, or more
/// than 63, it is changed. The rows of one signal are in memory at a time. Throws SetupError where the file
/// cannot be written, or a signal takes more than the 2 GB that such a file allows a variable.
void write_mat(const Recording& recording, const std::vector<ExportedSignal>& signals,
               const std::filesystem::path& file);

}  // namespace flinch
