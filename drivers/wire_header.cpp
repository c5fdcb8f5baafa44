#include "drivers/wire_header.h"

#include <random>

namespace flinch {

std::uint32_t draw_session() {
  std::random_device source;
  std::uint32_t session = 0;
  while (session == 0) session = static_cast<std::uint32_t>(source());
  return session;
}

std::uint32_t robot_hash(std::string_view description) noexcept {
  std::uint32_t hash = 0x811c9dc5U;
  for (const char letter : description) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x01000193U;
  return hash;
}

}  // namespace flinch
