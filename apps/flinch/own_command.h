#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flinch {

/// Runs this program with these words in a folder, to which the words' file names are relative, and returns
/// what it prints on stdout. Throws SetupError with what it says on stderr where it fails.
std::string run_own_command(const std::vector<std::string>& words, const std::filesystem::path& folder);

}  // namespace flinch
