#pragma once

#include <limits>

#include "systems/framework/time.h"

namespace flinch {

/// Whether the robot could stop within the limits that it keeps when a contact was last detected.
struct BrakingStatus {
  bool valid = false;         ///< a contact was detected, and motion and model were there
  Time judged{};              ///< tick at which it was detected
  bool stays_inside = false;  ///< It could: limits that are kept from then on need not be exceeded.
  /// Of the shortest straight stop from there [s]; infinite: none is possible.
  double duration = std::numeric_limits<double>::infinity();

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("judged", "ns", self.judged);
    visit("stays_inside", "", self.stays_inside);
    visit("duration", "s", self.duration);
  }
};

}  // namespace flinch
