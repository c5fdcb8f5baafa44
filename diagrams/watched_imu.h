#pragma once

#include "diagrams/stage.h"
#include "systems/safety/plausibility_monitor.h"

namespace flinch {

/// The IMU as the station tells it, and who says what of it can be believed.
struct WatchedImu {
  InputPort<ImuReading> reading;
  PlausibilityMonitor& monitor;
};

/// Adds the plausibility monitor, which reads nothing yet, and an input "imu" that may be left open.
WatchedImu add_watched_imu(const StageContext& site);

}  // namespace flinch
