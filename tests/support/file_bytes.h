#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace flinch::test {

/// All bytes of a file; none where there is no file.
inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace flinch::test
