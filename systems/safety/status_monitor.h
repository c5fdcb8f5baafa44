#pragma once

#include "systems/safety/angle_monitor.h"
#include "systems/signals/station_status.h"

namespace flinch {

/// What the station says of its brakes, against what they were told and what moves. Estimators and other
/// checks hold their breath while brakes are closed, so this word of the station is a reading like others.
struct StatusMonitor {
  bool opened = false;   ///< the station has said so since the brakes were told to open
  bool against = false;  ///< it says "closed", and they were told to open
  Time since{};          ///< tick at which that began
  JointVector angle;     ///< of the drives at that tick [rad or m]; empty: not known
  int moving = 0;        ///< ticks in a row with a drive that moves meanwhile
};

/// The watch after a tick. `engaged`: whether the brakes were told to close at the tick before.
void advance(StatusMonitor& watch, const StationStatus& status, bool engaged, const AngleMonitor& angles,
             const PlausibilityTick& tick, Plausibility& found) noexcept;

}  // namespace flinch
