#include "systems/safety/parity_watch.h"

#include <algorithm>

namespace flinch {
namespace {

/// Forward kinematics leaves the pose of the active angles also where the passive ones contradict it.
JointVector mismatch_of(const PlausibilityTick& tick) {
  const bool solved = tick.platform.valid() || tick.platform.status == PlatformMotion::Status::implausible;
  const JointVector& passive = tick.joints.passive;
  if (!solved || !tick.joints.passive_valid || tick.platform.acquired != tick.joints.acquired) return {};
  if (passive.size() != tick.robot.passive_joints() || !passive.allFinite()) return {};
  if (tick.platform.valid() && tick.kinematics.reachable)  // that of this pose, evaluated already
    return ParallelRobot::passive_difference(passive, tick.kinematics.joints.passive);
  const InverseSolution implied =
      tick.robot.inverse_kinematics(tick.platform.pose, tick.robot.home_working_mode());
  if (!implied.reachable) return {};
  return ParallelRobot::passive_difference(passive, implied.joints.passive);
}

}  // namespace

void advance(ParityWatch& watch, const PlausibilityTick& tick, Plausibility& found) noexcept {
  const JointVector mismatch = mismatch_of(tick);
  if (mismatch.size() == 0) return;
  if (tick.held && watch.learned < LearnedNoise::most) {
    if (watch.learned == 0) watch.offset.setZero(mismatch.size());
    ++watch.learned;
    watch.offset += (mismatch - watch.offset) / watch.learned;
  }
  if (watch.learned < LearnedNoise::enough) return;
  const JointVector left = ParallelRobot::passive_difference(mismatch, watch.offset);
  watch.mismatch[watch.count++ % watch.mismatch.size()] = padded(left);
  Padded<max_dof> mean = Padded<max_dof>::Zero();
  const std::size_t held = std::min(watch.count, watch.mismatch.size());
  for (std::size_t k = 0; k < held; ++k)
    mean += watch.mismatch[k] / static_cast<double>(watch.mismatch.size());
  const double now = left.lpNorm<Eigen::Infinity>() / (2.0 * tick.limits.parity);
  const double lasting = mean.lpNorm<Eigen::Infinity>() / (1.4 * tick.limits.parity);
  note(found, PlausibilityCheck::parity, std::max(now, lasting), GateFault::encoders_implausible);
}

}  // namespace flinch
