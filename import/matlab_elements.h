#pragma once

#include <filesystem>

namespace flinch {

/// Whether all of a file of MATLAB, level 5, is there and each part lies within the one that holds it.
/// Libraries read zeros where it is cut, and set aside as much memory as it claims. Throws SetupError, which
/// does not name the file.
void check_matlab_elements(const std::filesystem::path& file);

}  // namespace flinch
