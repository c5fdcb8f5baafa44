#pragma once

#include <cstdint>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// How strong a contact is against the two thresholds of [SafePR] Alg. 5.
enum class ContactLevel : std::uint8_t {
  none,
  reaction,  ///< a component reached the reaction threshold
  hard,      ///< a component reached the hard threshold
};

/// Whether the robot is touched. Both levels latch until the detector is reset.
struct ContactDetection {
  bool valid = false;                               ///< there is an estimate to judge
  ContactLevel level = ContactLevel::none;          ///< the highest level since the last reset
  ContactLevel present_level = ContactLevel::none;  ///< of this tick's estimate alone
  Time detected{};                ///< tick at which the reaction threshold was first reached
  PlatformVector wrench_in_base;  ///< the estimate at that tick [N, Nm]; empty before

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("level", "", self.level);
    visit("present_level", "", self.present_level);
    visit("detected", "ns", self.detected);
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
  }
};

}  // namespace flinch
