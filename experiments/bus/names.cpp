#include "experiments/bus/names.h"

#include <array>
#include <cstddef>

namespace flinch {

const char* name(DriveState state) {
  constexpr std::array<const char*, drive_state_count> names = {
      "not ready to switch on", "switch-on disabled", "ready to switch on", "switched on",
      "operation enabled",      "quick stop",         "fault reaction",     "fault"};
  const auto index = static_cast<std::size_t>(state);
  return index < names.size() ? names[index] : "unknown";
}

const char* name(ReactionMode mode) {
  constexpr std::array<const char*, 6> names = {"stopped", "nominal", "react", "hold", "zero-g", "recover"};
  const auto index = static_cast<std::size_t>(mode);
  return index < names.size() ? names[index] : "unknown";
}

}  // namespace flinch
