#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/model/friction_bounds.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/drive_load.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// Tells how the drives work: rates, friction and inertia of the model at the measured motion, and torques.
/// The motion must not lag behind them. Not valid where any input is not, or not finite.
class DriveLoads final : public System {
  State<FrictionBoundsMemory> memory_ = state<FrictionBoundsMemory>("memory");

 public:
  explicit DriveLoads(const std::shared_ptr<const Mechanism>& robot,
                      const FrictionBoundsSettings& friction = {});

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");

 private:
  Intermediate<FrictionBoundsMemory> next_ =
      intermediate<&DriveLoads::follow>("next", platform, kinematics, memory_);

 public:
  OutputPort<DriveLoad> load =
      output<&DriveLoads::tell>("load", platform, kinematics, dynamics, torque, next_);

 private:
  void follow(const PlatformMotion& motion, const Kinematics& at, const FrictionBoundsMemory& memory,
              FrictionBoundsMemory& next) const;
  void tell(const PlatformMotion& motion, const Kinematics& at, const Dynamics& model,
            const DriveTorque& drives, const FrictionBoundsMemory& friction, DriveLoad& result) const;

  Update remember_ = keep(memory_, next_);
  FrictionBounds friction_;
  int translations_;
};

}  // namespace flinch
