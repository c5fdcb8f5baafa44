#pragma once

#include <algorithm>

#include "drivers/drive_state_machine.h"
#include "systems/framework/system.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/station_status.h"

namespace flinch {

/// What the state machine of a drive must know of it: it has started as soon as its station says anything,
/// has a fault where the station reports one, and stands still while no active angle moves by more than
/// `resting_step` from tick to tick, of long ticks in each millisecond.
class DriveMonitor final : public System {
  State<JointReading> last_ = state<JointReading>("last");

 public:
  static constexpr double resting_step = 1e-4;  ///< [rad]; at 1 kHz 0.1 rad/s

  InputPort<StationStatus> status = input<StationStatus>("status");
  InputPort<JointReading> joints = input<JointReading>("joints");
  OutputPort<DriveCondition> condition = output<&DriveMonitor::watch>("condition", last_, status, joints);

 private:
  Update remember_ = keep(last_, joints);

  DriveCondition watch(const JointReading& last, const StationStatus& station,
                       const JointReading& now) const {
    const bool known = last.valid && now.valid && last.active.size() == now.active.size();
    const double milliseconds = std::max(1.0, 1e3 * to_seconds(now.acquired - last.acquired));
    const bool rests =
        known && (now.active - last.active).cwiseAbs().maxCoeff() <= milliseconds * resting_step;
    return {.started = station.valid, .fault = station.valid && station.fault, .standstill = rests};
  }
};

}  // namespace flinch
