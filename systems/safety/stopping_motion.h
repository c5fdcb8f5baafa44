#pragma once

#include "systems/framework/system.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// The platform's motion from the tick of a fault until the torque gate opens again, if no fault since then
/// calls anything in doubt; otherwise no data. So a controlled stop can keep the robot's limits where all
/// that this needs is known to be right. There is none where no controlled stop can follow: before the gate
/// has first opened, and once it has fallen back to the brakes.
class StoppingMotion final : public System {
  State<GateStatus> last_ = state<GateStatus>("last");

 public:
  InputPort<PlatformMotion> motion = input<PlatformMotion>("motion");
  InputPort<FaultReport> faults = input<FaultReport>("faults");
  InputPort<GateStatus> gate = input<GateStatus>("gate");
  OutputPort<PlatformMotion> trusted = output<&StoppingMotion::trust>("trusted", last_, motion, faults);

 private:
  Update remember_ = update<&StoppingMotion::status_of>(last_, gate);

  PlatformMotion trust(const GateStatus& last, const PlatformMotion& moving, const FaultReport& found) const;
  GateStatus status_of(const GateStatus& now) const { return now; }
};

}  // namespace flinch
