#pragma once

#include <filesystem>
#include <string>

namespace flinch {

/// All bytes of a file; none where it cannot be read.
std::string bytes_of_file(const std::filesystem::path& file);

}  // namespace flinch
