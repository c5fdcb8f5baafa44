#pragma once

#include <filesystem>
#include <string>

namespace flinch {

/// Why a file that somebody has named cannot be read, in words that go after its name; empty if it can.
/// Whoever opens a pipe or a device may wait for ever, and so may who reads a file of the kernel, which says
/// that it is empty: these cannot.
std::string problem_with_reading(const std::filesystem::path& file);

/// The part of it that the name tells: what cannot be the name of a file, to read or to write.
std::string problem_with_name(const std::filesystem::path& file);

/// The part of it that the kind of what is there tells: empty for a regular file.
std::string problem_with_kind(const std::filesystem::file_status& status);

}  // namespace flinch
