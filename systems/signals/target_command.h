#pragma once

#include <cstdint>

#include "systems/robot/vectors.h"

namespace flinch {

/// Where the operator wants the platform to go. It counts once, at the tick at which its number changes.
struct TargetCommand {
  enum class Kind : std::uint8_t {
    none,
    pose,  ///< to `pose`
    step,  ///< by `step` from where it shall be now; of zeros: come to rest
  };
  std::uint32_t number = 0;
  Kind kind = Kind::none;
  Configuration pose;   ///< in the base frame
  PlatformVector step;  ///< in the base frame

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("number", "", self.number);
    visit("kind", "", self.kind);
    visit("pose", "<pose>", self.pose, "base");
    visit("step", "<displacement>", self.step, "base");
  }
};

}  // namespace flinch
