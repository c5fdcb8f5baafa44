#pragma once

#include <array>

#include "systems/framework/time.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// How long before now each moment of a course lies: close together where an estimate still follows what has
/// just happened, far apart before.
inline constexpr std::array window_ages{0ms, 1ms, 2ms, 3ms, 5ms, 7ms, 10ms, 15ms, 20ms, 25ms, 35ms, 45ms};

/// What was estimated and how the platform moved at one moment.
struct ContactMoment {
  PlatformVector wrench_in_base;  ///< [N, Nm]
  PlatformVector velocity;  ///< of the platform [m/s, rad/s], in the base frame, as the encoders tell it
};

/// At each of `window_ages`.
using ContactMoments = std::array<ContactMoment, window_ages.size()>;

/// How a contact has come about: the estimated wrench and the motion of late, from before it on.
struct ContactWindow {
  Time acquired{};
  bool valid = false;  ///< All moments are known. Otherwise they mean nothing.
  ContactMoments moments;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
  }
};

}  // namespace flinch
