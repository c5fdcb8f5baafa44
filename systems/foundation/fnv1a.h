#pragma once

#include <cstdint>
#include <string_view>

namespace flinch {

/// A number by which texts are told from one another, short of intent: FNV-1a. A text that follows another
/// one `goes_on` from its number.
constexpr std::uint64_t fnv1a(std::string_view text, std::uint64_t goes_on = 0xcbf29ce484222325U) {
  for (const char letter : text) goes_on = (goes_on ^ static_cast<unsigned char>(letter)) * 0x100000001b3U;
  return goes_on;
}

}  // namespace flinch
