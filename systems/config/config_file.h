#pragma once

#include <filesystem>
#include <string>

namespace flinch {

/// What is wrong with `file` as a file to read, such as "no such file; did you mean 'planar_3rrr.yaml'?"
/// with the name nearest to it in the same folder; empty if it can be read.
std::string problem_with_file(const std::filesystem::path& file);

/// All of its text. Throws SetupError if it is missing, a folder or no regular file, not readable, no text,
/// or larger than any file of settings.
std::string read_config_file(const std::filesystem::path& file);

}  // namespace flinch
