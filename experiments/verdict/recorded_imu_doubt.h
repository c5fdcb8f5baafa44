#pragma once

#include "systems/signals/imu_doubt.h"

namespace flinch {

/// What of the recorded plausibility tells whether the IMU was believed.
struct RecordedImuDoubt {
  ImuDoubt doubt = ImuDoubt::none;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("imu_doubt", "", self.doubt);
  }
};

}  // namespace flinch
