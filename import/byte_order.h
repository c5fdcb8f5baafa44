#pragma once

#include <cstdint>
#include <string_view>

namespace flinch {

/// A whole number of up to 8 bytes, without a sign; its lowest byte stands first unless `is_big`.
inline std::uint64_t number_of_bytes(std::string_view bytes, bool is_big = false) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t place = is_big ? bytes.size() - 1 - i : i;
    number |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * place);
  }
  return number;
}

}  // namespace flinch
