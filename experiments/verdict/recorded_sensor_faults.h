#pragma once

#include <string>

#include "systems/framework/recording.h"
#include "systems/signals/imu_fault.h"
#include "systems/signals/plausibility.h"

namespace flinch {

/// What of the recorded plausibility tells whom the robot did without.
struct RecordedSensorFaults {
  ImuFault imu = ImuFault::none;
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

/// Whether a signal of the recording has this field: not that of every version has.
bool records(const Recording& recording, const char* signal, const char* name);

/// For how much of a recording its robot did without its IMU, and why at first.
struct ImuLeftOut {
  ImuFault why = ImuFault::none;
  double share = 0.0;  ///< Of the samples.
};

/// Nothing was left out of recordings that do not tell.
ImuLeftOut imu_left_out(const Recording& recording);

/// The same in words for who calibrates by that recording; "": nothing was left out.
std::string told_left_out(const ImuLeftOut& imu);

}  // namespace flinch
