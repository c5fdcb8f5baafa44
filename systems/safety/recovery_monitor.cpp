#include "systems/safety/recovery_monitor.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double beyond_range(const JointVector& position, const WorkspaceLimits& limits) {
  if (position.size() == 0 || !position.allFinite()) return unknown;
  const double beyond =
      std::max(limits.min_active - position.minCoeff(), position.maxCoeff() - limits.max_active);
  return beyond / (limits.max_active - limits.min_active);
}

}  // namespace

PlaceExcess place_excess(const PlaceTick& tick) noexcept {
  const WorkspaceLimits& limits = tick.limits;
  PlaceExcess excess;
  excess.fill(unknown);
  auto& [type_1, type_2, radius, orientation, range, self_collision] = excess;
  if (tick.motion.valid) range = beyond_range(tick.motion.position, limits);
  if (!tick.platform.valid() || !tick.robot.space().contains(tick.platform.pose)) return excess;
  radius = distance_from_centre(limits, tick.robot, tick.platform.pose) / limits.max_distance - 1.0;
  orientation = tick.robot.space().rotation_angle(tick.platform.pose) / limits.max_rotation - 1.0;
  if (!tick.measures.valid) return excess;
  type_1 = 1.0 - std::abs(tick.measures.det_B) / limits.min_abs_det_B;
  if (tick.measures.det_A > 0.0) type_2 = 1.0 - tick.measures.det_A / limits.min_abs_det_A;
  self_collision = 1.0 - tick.measures.sigma_sc / limits.min_self_collision_distance;
  if (limits.min_platform_gap > 0.0)
    self_collision = std::max(self_collision, 1.0 - tick.measures.platform_gap / limits.min_platform_gap);
  return excess;
}

void advance(RecoveryMonitor& watch, const PlaceTick& tick, bool recovering) noexcept {
  watch.now = place_excess(tick);
  if (!recovering || !watch.recovering) watch.least.fill(std::numeric_limits<double>::infinity());
  watch.recovering = recovering;
  if (!recovering) return;
  for (std::size_t i = 0; i < watch.now.size(); ++i) {
    if (!std::isnan(watch.now[i])) watch.least[i] = std::min(watch.least[i], std::max(watch.now[i], 0.0));
  }
}

FaultMask tolerable_faults(const RecoveryMonitor& watch, double margin) noexcept {
  FaultMask tolerable = 0;
  for (std::size_t i = 0; i < faults_of_place.size(); ++i) {
    if (watch.now[i] <= watch.least[i] + margin) tolerable |= fault_bit(faults_of_place[i]);
  }
  return tolerable;
}

}  // namespace flinch
