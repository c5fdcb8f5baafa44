#pragma once

#include "systems/framework/system.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/drive_load.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// Tells how the drives work: rates, friction and inertia of the model at the measured motion, and torques.
/// The motion must not lag behind them. Not valid where any input is not, or not finite.
class DriveLoads final : public System {
 public:
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");
  OutputPort<DriveLoad> load = output<&DriveLoads::tell>("load", platform, kinematics, dynamics, torque);

 private:
  void tell(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
            const DriveTorque& drives, DriveLoad& result) const;
};

}  // namespace flinch
