#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flinch::test {

/// A folder of this program, in memory where the system has such a one; gone when the program ends.
const std::filesystem::path& fuzz_folder();

/// Writes the bytes to a file in it.
std::filesystem::path fuzz_file(const std::string& name, std::string_view bytes);

/// The files of a folder of apps/ with that extension, in the order of their names; what they name by
/// "../FOLDER" they name by its whole path.
std::vector<std::string> shipped_files(const std::string& folder, const std::string& extension);

}  // namespace flinch::test
