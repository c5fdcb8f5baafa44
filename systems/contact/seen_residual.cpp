#include "systems/contact/seen_residual.h"

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

DriveResidual minus(const DriveResidual& a, const DriveResidual& b) {
  return {a.effort - b.effort, a.torque - b.torque, a.friction - b.friction,
          a.slope - b.slope,   a.rising - b.rising, a.rest - b.rest};
}

/// a + share (b - a)
DriveResidual towards(const DriveResidual& a, const DriveResidual& b, double share) {
  const DriveResidual way = minus(b, a);
  return {a.effort + share * way.effort, a.torque + share * way.torque, a.friction + share * way.friction,
          a.slope + share * way.slope,   a.rising + share * way.rising, a.rest + share * way.rest};
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
  load.inertia = before.inertia + later * (after.inertia - before.inertia);
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
  const double doubt = torque_unknown ? 1.0 : driven_doubt(then.acquired - before->acquired);
  level.rising = doubt * (after->torque - before->torque);
}

/// 1 at rest, 1/e at the resting rate.
JointVector rest_of(const JointVector& rate, double resting_rate) {
  return (-(rate.array() / resting_rate).square()).exp();
}

/// Passes a load through the filters of an answer, which have settled on it where it is the first one; `T` is
/// the time since the last one [s].
AnsweredLoad answered(const AnsweredLoad& load, const EstimatorAnswer& answer, bool is_first, double T,
                      ResidualMemory& next) {
  AnsweredLoad now = load;
  const double share = is_first ? 1.0 : 1.0 - std::exp(-answer.rate * T);
  for (int i = 0; i < answer.filters; ++i) {
    AnsweredLoad& filter = next.answered[static_cast<std::size_t>(i)];
    if (is_first) filter = now;
    filter.torque += share * (now.torque - filter.torque);
    filter.friction += share * (now.friction - filter.friction);
    filter.rest += share * (now.rest - filter.rest);
    now = filter;
  }
  return now;
}

}  // namespace

void follow_residual(const WrenchEstimate& estimate, const DriveLoad& fresh, const LoadHistory& past,
                     Time now, const ResidualTracking& tracking, const ResidualMemory& memory,
                     ResidualMemory& next) {
  const bool is_new = is_usable(estimate) && (!memory.started || estimate.acquired > memory.acquired);
  std::optional<DriveLoad> then;
  if (is_new)
    then =
        sample_at(estimate.acquired, past, fresh.valid ? &fresh : nullptr, tracking.sampling, interpolated);
  next = memory;
  next.seen.is_new = false;
  if (!then || then->torque.size() != estimate.drive_torque.size()) {
    if (tracking.sampling.expired(memory.arrived, now)) next.started = false;
    return;
  }
  const bool continued = memory.started && !tracking.sampling.interrupted(memory.acquired, estimate.acquired);
  const double T = to_seconds(estimate.acquired - memory.acquired);
  const AnsweredLoad load =
      answered({then->torque, then->friction, rest_of(then->rate, tracking.resting_rate)}, tracking.answer,
               !continued, T, next);
  const JointVector none = JointVector::Zero(load.torque.size());
  DriveResidual level{estimate.drive_torque, load.torque, load.friction, none, none, load.rest};
  if (continued && tracking.answer.filters > 0) level.slope = (load.torque - memory.seen.level.torque) / T;
  if (continued && tracking.answer.filters == 0) see_hold(*then, fresh, past, tracking.sampling, level);
  if (!continued) {
    next.mean = level;
    next.seen.smoothed = level;
    next.since = now;
  }
  next.started = true;
  next.seen.is_new = true;
  next.seen.settled = now - next.since >= tracking.settling_time();
  next.seen.smooth = now - next.since >= tracking.smoothing_time();
  next.seen.load = *then;
  next.seen.level = level;
  next.seen.change = minus(level, next.mean);
  if (continued) {
    next.mean = towards(next.mean, level, 1.0 - std::exp(-tracking.rate * T));
    next.seen.smoothed = towards(next.seen.smoothed, level, 1.0 - std::exp(-tracking.smoothing * T));
  }
  next.acquired = estimate.acquired;
  next.arrived = now;
}

}  // namespace flinch
