#include "systems/foundation/bytes_of_file.h"

#include <fstream>
#include <iterator>

namespace flinch {

std::string bytes_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace flinch
