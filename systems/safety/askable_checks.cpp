#include "systems/safety/askable_checks.h"

#include "systems/safety/plausibility_monitor.h"

namespace flinch {
namespace {

/// Whether there is so much noise in every drive's signal that it would be missed.
template <class Watch>
bool all_noisy(const Watch& watch, const PlausibilityTick& tick) {
  for (Eigen::Index i = 0; i < tick.robot.drives(); ++i) {
    if (!watch.is_noisy(i, tick)) return false;
  }
  return true;
}

CheckMask when(bool given, std::initializer_list<PlausibilityCheck> checks) {
  CheckMask mask = 0;
  for (const PlausibilityCheck check : checks) mask |= given ? check_bit(check) : 0;
  return mask;
}

}  // namespace

CheckMask askable_checks(const PlausibilityMemory& memory, const PlausibilityTick& tick) noexcept {
  using enum PlausibilityCheck;
  const bool angles = memory.angles.readings > 0;
  const bool currents = memory.currents.readings > 0;  // with the drives' torque constants
  const bool acts = tick.limits.commands_act;
  const bool inertial = memory.imu_missing == 0 && memory.inertial.gyroscope.known();
  const bool passive = memory.passive_missing == 0 && memory.parity.knows_offset();
  return when(true, {stop}) | when(angles, {brakes}) |
         when(angles && acts, {jump, isolated, pair, still, response}) | when(acts, {status}) |
         when(all_noisy(memory.angles, tick), {quiet_angle}) | when(inertial, {gyroscope, accelerometer}) |
         when(passive, {parity}) | when(currents && acts, {tube}) |
         when(all_noisy(memory.currents, tick), {quiet_current});
}

}  // namespace flinch
