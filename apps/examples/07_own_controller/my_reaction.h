#pragma once

#include "diagrams/control_stages.h"
#include "systems/framework/system.h"

/// A reaction of your own: the drives push on with what pushes them, and brake,
///   tau = a tau_ext - d dq_a/dt,
/// so that it gives way as if it were 1 + a times as light, and comes to rest where nothing pushes it.
class MyReaction final : public flinch::System {
 public:
  MyReaction(double amplification, double damping) : a_(amplification), d_(damping) {}

  flinch::InputPort<flinch::WrenchEstimate> wrench = input<flinch::WrenchEstimate>("wrench");
  flinch::InputPort<flinch::JointMotion> drives = input<flinch::JointMotion>("drives");
  flinch::InputPort<flinch::Kinematics> kinematics = input<flinch::Kinematics>("kinematics");

  flinch::OutputPort<flinch::TorqueCommand> torque =
      output<&MyReaction::give_way>("torque", clock, wrench, drives);
  flinch::OutputPort<flinch::PlatformReference> reference =
      output<&MyReaction::stay>("reference", kinematics);

 private:
  flinch::TorqueCommand give_way(flinch::Time now, const flinch::WrenchEstimate& touch,
                                 const flinch::JointMotion& motion) const {
    if (!motion.valid) return {.computed = now, .valid = false, .torque = {}};
    flinch::JointVector asked = -d_ * motion.velocity;
    if (touch.valid) asked += a_ * touch.drive_torque;
    return {.computed = now, .valid = true, .torque = asked};
  }
  /// It leads nowhere, so it never ends by itself.
  flinch::PlatformReference stay(const flinch::Kinematics& at) const {
    const flinch::PlatformVector rest = flinch::PlatformVector::Zero(at.velocity.size());
    return {.valid = at.valid, .finished = false, .pose = at.pose, .velocity = rest, .acceleration = rest};
  }

  double a_, d_;  // [1], [Nm s/rad]
};

/// How it is added to the control path.
inline flinch::ControlLaw my_reaction(double amplification, double damping) {
  return {"my_reaction",
          [=](const flinch::StageContext& site, const flinch::ReactionPorts& given) -> flinch::LawPorts {
            auto& block = site.builder.add<MyReaction>(site.name, amplification, damping);
            site.builder.connect(given.wrench, block.wrench);
            site.builder.connect(given.joint_motion, block.drives);
            site.builder.connect(given.kinematics, block.kinematics);
            return {.torque = block.torque, .reference = block.reference};
          }};
}
