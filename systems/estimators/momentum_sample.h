#pragma once

#include <cstdint>

#include "systems/framework/time.h"
#include "systems/robot/dynamics.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// All that an observer of the generalised momentum must know of one instant. [SafePR] (11), (12)
struct MomentumSample {
  bool valid = false;  ///< All of it was valid and finite; otherwise the rest is empty.
  Time acquired{};
  PlatformVector p;       ///< M_x dx [Ns, Nms]
  PlatformVector beta;    ///< g_x + F_fr_x - C_x^T dx [N, Nm]
  PlatformMatrix J_qa_x;  ///< Drive torques to platform wrench: F_a = J_qa_x^T tau_a.
  JointVector torque;     ///< tau_a [Nm or N]
  bool braked = false;    ///< Brakes add to it what nobody measures.
};

/// The sample of one tick.
MomentumSample momentum_sample(const PlatformMotion& platform, const Kinematics& kinematics,
                               const Dynamics& dynamics, const DriveTorque& torque);

/// When a torque that was acquired at t_k acts.
enum class TorqueTiming : std::uint8_t {
  sampled,  ///< It is the torque at t_k, between samples as the mean of both. Aligned torques are such.
  held,     ///< The drive held it over (t_{k-1}, t_k]: the reading of a current that followed its command.
};

/// Mean over the interval from `previous` to `now` of all that should change the momentum, s = F_a - beta
/// [N, Nm], so that dp/dt = s + F_ext. Second order in the interval if `timing` is right, first order if
/// not.
PlatformVector mean_known_wrench(const MomentumSample& previous, const MomentumSample& now,
                                 TorqueTiming timing);

}  // namespace flinch
