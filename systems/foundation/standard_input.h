#pragma once

#include <filesystem>
#include <string_view>

namespace flinch {

/// As which users name standard input in the place of a file.
inline constexpr std::string_view standard_input_name = "-";

/// A file with all that standard input holds, which is read at the first call, to its end. It goes with the
/// program. Throws SetupError where it cannot be read or kept.
const std::filesystem::path& standard_input_file();

/// In which folder the files lie that `file` names without one: its own, and that of the program for standard
/// input.
std::filesystem::path folder_named_in(const std::filesystem::path& file);

}  // namespace flinch
