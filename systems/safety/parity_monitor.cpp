#include "systems/safety/parity_monitor.h"

#include <algorithm>

#include "systems/safety/encoder_monitor.h"

namespace flinch {
void advance(ParityMonitor& watch, const PlausibilityTick& tick, Plausibility& found) noexcept {
  const JointVector mismatch = passive_mismatch(tick.robot, tick.joints, tick.platform, tick.kinematics);
  if (mismatch.size() == 0) return;
  if (tick.held && watch.learned < LearnedNoise::most) {
    if (watch.learned == 0) watch.offset.setZero(mismatch.size());
    ++watch.learned;
    watch.offset += (mismatch - watch.offset) / watch.learned;
  }
  if (!watch.knows_offset()) return;
  const JointVector left = ParallelRobot::passive_difference(mismatch, watch.offset);
  const auto window = static_cast<std::size_t>(tick.looks(16ms));
  watch.mismatch[watch.count++ % window] = padded(left);
  Padded<max_dof> mean = Padded<max_dof>::Zero();
  const std::size_t held = std::min(watch.count, window);
  for (std::size_t k = 0; k < held; ++k) mean += watch.mismatch[k] / static_cast<double>(window);
  const double now = left.lpNorm<Eigen::Infinity>() / (2.0 * tick.limits.parity);
  const double lasting = mean.lpNorm<Eigen::Infinity>() / (1.4 * tick.limits.parity);
  note(found, PlausibilityCheck::parity, std::max(now, lasting), GateFault::encoders_implausible);
}

}  // namespace flinch
