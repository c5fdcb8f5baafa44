#include "systems/contact/residual_sample.h"

#include <array>
#include <cmath>
#include <optional>

#include "systems/signals/driven_share.h"
#include "systems/signals/sample_at.h"

namespace flinch {
namespace {

bool is_usable(const WrenchEstimate& estimate) {
  return estimate.valid && !estimate.health.fallen_back && estimate.drive_torque.size() > 0 &&
         estimate.drive_torque.allFinite();
}

constexpr std::array parts = {&DriveResidual::effort, &DriveResidual::torque, &DriveResidual::friction,
                              &DriveResidual::slope,  &DriveResidual::rising, &DriveResidual::rest};

/// difference = a - b, part by part.
void subtract(const DriveResidual& a, const DriveResidual& b, DriveResidual& difference) {
  for (const auto part : parts) difference.*part = a.*part - b.*part;
}

/// next = mean + share (seen - mean), part by part.
void follow(const DriveResidual& mean, const DriveResidual& seen, double share, DriveResidual& next) {
  for (const auto part : parts) next.*part = mean.*part + share * (seen.*part - mean.*part);
}

/// The load between two ticks, as if it changed evenly.
DriveLoad interpolated(const Around<DriveLoad>& around, Time time) {
  const DriveLoad &before = *around.before, &after = *around.after;
  const double later = around.share(time);
  DriveLoad load;
  load.acquired = time;
  load.valid = true;
  load.rate = before.rate + later * (after.rate - before.rate);
  load.torque = before.torque + later * (after.torque - before.torque);
  load.friction = before.friction + later * (after.friction - before.friction);
  load.friction_bounds = interval_between(before.friction_bounds, after.friction_bounds, later);
  load.inertia = before.inertia + later * (after.inertia - before.inertia);
  load.turning = before.turning + later * (after.turning - before.turning);
  return load;
}

/// Of the hold in which `then` lies, which the drives reach some time after the tick before: the slope of the
/// torque, and how much of its step is in doubt at that instant. Both are zero where it is not known.
void see_hold(const DriveLoad& then, const DriveLoad& fresh, const LoadHistory& past,
              const Sampling& sampling, DriveResidual& level) {
  const DriveLoad* const after = past.around(then.acquired, fresh.valid ? &fresh : nullptr).after;
  const DriveLoad* const before = past.last_before(then.acquired);
  if (after == nullptr || before == nullptr || sampling.interrupted(before->acquired, after->acquired))
    return;
  const Time hold = after->acquired - before->acquired;
  level.slope = (after->torque - before->torque) / to_seconds(hold);
  if (then.acquired == after->acquired) return;
  const bool torque_unknown = sampling.lost_between(before->acquired, after->acquired);
  const double doubt = torque_unknown ? 1.0 : driven_uncertainty(then.acquired - before->acquired);
  level.rising = doubt * (after->torque - before->torque);
}

/// 1 at rest, 1/e at the resting rate.
JointVector rest_of(const JointVector& rate, double resting_rate) {
  return (-(rate.array() / resting_rate).square()).exp();
}

/// Passes torque, friction and rest of a residual, and the bounds of its friction, through the filters of an
/// answer, which have settled where they are the first; `T` is the time since the last ones [s].
void answer(const FilterResponse& by, bool is_first, double T, const ResidualMemory& memory,
            ResidualMemory& next, FrictionInterval& bounds) {
  DriveResidual& level = next.seen.level;
  const double share = is_first ? 1.0 : 1.0 - std::exp(-by.rate * T);
  for (std::size_t i = 0; i < static_cast<std::size_t>(by.filters); ++i) {
    FilteredLoad& filter = next.answered[i];
    if (is_first) {
      filter = {level.torque, level.friction, bounds, level.rest};
      continue;
    }
    const FilteredLoad& last = memory.answered[i];
    level.torque = filter.torque = last.torque + share * (level.torque - last.torque);
    level.friction = filter.friction = last.friction + share * (level.friction - last.friction);
    bounds = filter.friction_bounds = interval_between(last.friction_bounds, bounds, share);
    level.rest = filter.rest = last.rest + share * (level.rest - last.rest);
  }
}

}  // namespace

void track_residual(const WrenchEstimate& estimate, const DriveLoad& fresh, const LoadHistory& past, Time now,
                    const ResidualTracking& tracking, const ResidualMemory& memory, ResidualMemory& next) {
  const bool is_new = is_usable(estimate) && (!memory.started || estimate.acquired > memory.acquired);
  std::optional<DriveLoad> then;
  if (is_new)
    then =
        sample_at(estimate.acquired, past, fresh.valid ? &fresh : nullptr, tracking.sampling, interpolated);
  if (!then || then->torque.size() != estimate.drive_torque.size()) {
    next = memory;
    next.seen.is_new = false;
    if (tracking.sampling.expired(memory.arrived, now)) next.started = false;
    return;
  }
  const bool continued = memory.started && !tracking.sampling.interrupted(memory.acquired, estimate.acquired);
  const double T = to_seconds(estimate.acquired - memory.acquired);
  DriveResidual& level = next.seen.level;
  level.effort = estimate.drive_torque;
  level.torque = then->torque;
  level.friction = then->friction;
  level.rest = rest_of(then->rate, tracking.resting_rate);
  level.slope = level.rising = JointVector::Zero(level.effort.size());
  FrictionInterval bounds = then->friction_bounds;
  answer(tracking.answer, !continued, T, memory, next, bounds);
  level.effort = bounds.outside(level.effort);
  next.seen.hidden = bounds.width();
  if (continued && tracking.answer.filters > 0) level.slope = (level.torque - memory.seen.level.torque) / T;
  if (continued && tracking.answer.filters == 0) see_hold(*then, fresh, past, tracking.sampling, level);
  if (continued) {
    next.since = memory.since;
    subtract(level, memory.mean, next.seen.change);
    follow(memory.mean, level, 1.0 - std::exp(-tracking.rate * T), next.mean);
    follow(memory.seen.smoothed, level, 1.0 - std::exp(-tracking.smoothing * T), next.seen.smoothed);
  } else {
    next.since = now;
    next.mean = next.seen.smoothed = level;
    subtract(level, next.mean, next.seen.change);
  }
  next.started = true;
  next.seen.is_new = true;
  next.seen.settled = now - next.since >= tracking.settling_time();
  next.seen.smooth = now - next.since >= tracking.smoothing_time();
  next.seen.load = *then;
  next.acquired = estimate.acquired;
  next.arrived = now;
}

}  // namespace flinch
