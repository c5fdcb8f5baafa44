#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/model/friction_interval.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/drive_load.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// Tells how the drives work: rates, friction and inertia of the model at the measured motion, and torques.
/// The motion must not lag behind them. Not valid where any input is not, or not finite.
class DriveLoads final : public System {
  State<FrictionIntervalMemory> memory_ = state<FrictionIntervalMemory>("memory");

 public:
  explicit DriveLoads(const std::shared_ptr<const Mechanism>& robot,
                      const FrictionIntervalSettings& friction = {});

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");

 private:
  Intermediate<FrictionIntervalMemory> next_ =
      intermediate<&DriveLoads::follow>("next", platform, kinematics, memory_);

 public:
  OutputPort<DriveLoad> load =
      output<&DriveLoads::tell>("load", platform, kinematics, dynamics, torque, next_);

 private:
  void follow(const PlatformMotion& motion, const Kinematics& at, const FrictionIntervalMemory& memory,
              FrictionIntervalMemory& next) const;
  void tell(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
            const DriveTorque& drives, const FrictionIntervalMemory& friction, DriveLoad& result) const;

  Update remember_ = keep(memory_, next_);
  FrictionBounds friction_;
  int translations_;
};

}  // namespace flinch
