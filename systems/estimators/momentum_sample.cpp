#include "systems/estimators/momentum_sample.h"

namespace flinch {

MomentumSample momentum_sample(const PlatformMotion& platform, const Kinematics& kinematics,
                               const Dynamics& dynamics, const DriveTorque& torque) {
  if (!platform.valid() || !kinematics.valid || !dynamics.valid || !torque.valid) return {};
  if (torque.torque.size() != drive_count(kinematics) || !torque.torque.allFinite()) return {};

  const PlatformVector& dx = kinematics.velocity;
  MomentumSample sample;
  sample.acquired = platform.acquired;
  sample.p = dynamics.M_x * dx;
  sample.beta = dynamics.g_x + dynamics.F_fr_x - dynamics.C_x.transpose() * dx;  // [SafePR] (12)
  sample.J_qa_x = kinematics.J_qa_x;
  sample.torque = torque.torque;
  sample.braked = torque.braked;
  sample.valid = sample.p.allFinite() && sample.beta.allFinite() && sample.J_qa_x.allFinite();
  return sample.valid ? sample : MomentumSample();
}

PlatformVector mean_known_wrench(const MomentumSample& previous, const MomentumSample& now,
                                 TorqueTiming timing) {
  const JointVector& previous_torque = timing == TorqueTiming::held ? now.torque : previous.torque;
  const PlatformVector F_a_begin = previous.J_qa_x.transpose() * previous_torque;
  const PlatformVector F_a_end = now.J_qa_x.transpose() * now.torque;
  return 0.5 * (F_a_begin + F_a_end - previous.beta - now.beta);
}

}  // namespace flinch
