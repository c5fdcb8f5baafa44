#pragma once

#include "systems/framework/system.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/torque_command.h"

namespace flinch {

/// Compensates gravity and nothing else: tau = g_qa = J_x,qa^T g_x. [SafePR] IV-A. Zero for a robot that
/// moves horizontally. Not valid where kinematics or dynamics are not.
class ZeroGravity final : public System {
 public:
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");
  OutputPort<TorqueCommand> torque = output<&ZeroGravity::compensate>("torque", clock, kinematics, dynamics);

 private:
  void compensate(Time now, const Kinematics& at, const Dynamics& model, TorqueCommand& command) const;
};

}  // namespace flinch
