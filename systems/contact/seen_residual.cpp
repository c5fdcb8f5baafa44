#include "systems/contact/seen_residual.h"

#include <cmath>

namespace flinch {
namespace {

bool is_usable(const WrenchEstimate& estimate) {
  return estimate.valid && !estimate.health.fallen_back && estimate.drive_torque.size() > 0 &&
         estimate.drive_torque.allFinite();
}

DriveResidual minus(const DriveResidual& a, const DriveResidual& b) {
  return {a.effort - b.effort, a.torque - b.torque, a.friction - b.friction};
}

/// a + share (b - a)
DriveResidual towards(const DriveResidual& a, const DriveResidual& b, double share) {
  const DriveResidual way = minus(b, a);
  return {a.effort + share * way.effort, a.torque + share * way.torque, a.friction + share * way.friction};
}

}  // namespace

void follow_residual(const WrenchEstimate& estimate, const DriveLoad& fresh, const LoadHistory& past,
                     Time now, const ResidualTracking& tracking, const ResidualMemory& memory,
                     ResidualMemory& next) {
  const bool is_new = is_usable(estimate) && (!memory.started || estimate.acquired > memory.acquired);
  const DriveLoad* then = is_new ? past.first_from(estimate.acquired) : nullptr;
  if (is_new && then == nullptr && fresh.valid && fresh.acquired >= estimate.acquired) then = &fresh;
  next = memory;
  next.seen.is_new = false;
  if (then == nullptr || then->torque.size() != estimate.drive_torque.size()) {
    if (tracking.sampling.expired(memory.arrived, now)) next.started = false;
    return;
  }
  const DriveResidual level{estimate.drive_torque, then->torque, then->friction};
  const bool continued = memory.started && !tracking.sampling.interrupted(memory.acquired, estimate.acquired);
  if (!continued) {
    next.mean = level;
    next.since = now;
  }
  next.started = true;
  next.seen.is_new = true;
  next.seen.settled = now - next.since >= tracking.settling_time();
  next.seen.load = *then;
  next.seen.level = level;
  next.seen.change = minus(level, next.mean);
  if (continued) {
    const double T = to_seconds(estimate.acquired - memory.acquired);
    next.mean = towards(next.mean, level, 1.0 - std::exp(-tracking.rate * T));
  }
  next.acquired = estimate.acquired;
  next.arrived = now;
}

}  // namespace flinch
