#pragma once

#include <filesystem>
#include <string>

namespace flinch {

/// Writes the parameter file `text`. Throws SetupError where flinch itself would refuse to read it; nothing
/// is written then.
void write_parameters(const std::filesystem::path& file, const std::string& text);

}  // namespace flinch
