#pragma once

#include "systems/signals/imu_doubt.h"
#include "systems/signals/plausibility.h"

namespace flinch {

/// What of the recorded plausibility tells whom the robot did without.
struct RecordedDoubts {
  ImuDoubt imu = ImuDoubt::none;
  bool passive_lost = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("imu_doubt", "", self.imu);
    visit("passive_lost", "", self.passive_lost);
  }
};

/// Which questions to sensors and drives could be asked. Recordings of versions before do not tell.
struct RecordedAskable {
  CheckMask askable = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("askable", "", self.askable);
  }
};

}  // namespace flinch
