#include "systems/safety/angle_monitor.h"

#include <algorithm>
#include <cmath>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

template <class Ring, class Value>
void push(Ring& ring, const Value& value) {
  std::move(ring.begin() + 1, ring.end(), ring.begin());
  ring.back() = value;
}

bool is_new_reading(const AngleMonitor& watch, const PlausibilityTick& tick) {
  const JointVector& angle = tick.joints.active;
  return tick.joints.valid && angle.size() == tick.robot.drives() && angle.allFinite() &&
         (watch.readings == 0 || tick.joints.acquired > watch.acquired);
}

/// How the drives' rates change in a second: J_qa,x M_x^-1 (J_qa,x^T tau - C v - g - F_fr) + dJ_qa,x v.
/// [SafePR] (4)
JointVector drive_acceleration(const PlausibilityTick& tick, const JointVector& torque) {
  const Kinematics& k = tick.kinematics;
  const Dynamics& d = tick.dynamics;
  if (!k.valid || !d.valid || torque.size() != k.J_qa_x.rows()) return {};
  const PlatformVector force = k.J_qa_x.transpose() * torque - d.C_x * k.velocity - d.g_x - d.F_fr_x;
  return k.J_qa_x * d.M_x.llt().solve(force) + k.dJ_qa_x * k.velocity;
}

void judge_change(AngleMonitor& watch, const PlausibilityTick& tick, Plausibility& found) {
  using enum PlausibilityCheck;
  const PlausibilityLimits& limits = tick.limits;
  const double in_a_tick = limits.drive_acceleration * tick.T();
  const auto& [before, at, after] = watch.residual;
  for (Eigen::Index i = 0; i < after.size(); ++i) {
    const int drive = static_cast<int>(i);
    const double noise = watch.change.deviation(i, 0.1 * in_a_tick);
    note(found, jump, std::abs(after[i]) / (limits.jump * in_a_tick), GateFault::encoder_jump, drive);
    if (watch.residuals < 2) continue;
    const bool turns = at[i] * after[i] < 0.0;
    const double smaller = std::min(std::abs(at[i]), std::abs(after[i]));
    if (turns) note(found, pair, smaller / (limits.pair * noise), GateFault::encoder_jump, drive);
    if (watch.residuals < 3) continue;
    const double beside = std::max(std::abs(before[i]), std::abs(after[i]));
    const bool alone = beside < limits.neighbours * std::abs(at[i]);
    if (alone)
      note(found, isolated, std::abs(at[i]) / (limits.isolated * noise), GateFault::encoder_jump, drive);
  }
}

/// Third differences of an angle whose noise is gone. Where there never was much there is nothing to miss.
void judge_quiet(AngleMonitor& watch, const PlausibilityTick& tick, Plausibility& found) {
  const auto& [a, b, c, d] = watch.angle;
  const QuietRow row = quiet_row(tick.limits, tick.period);
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    int& ticks = watch.quiet[static_cast<std::size_t>(i)];
    const double noise = watch.change.deviation(i, 0.0);
    const double third = std::abs(d[i] - 3.0 * c[i] + 3.0 * b[i] - a[i]) / tick.T();
    const bool is_quiet = watch.is_noisy(i, tick) && third < row.share * noise;
    ticks = is_quiet ? ticks + 1 : 0;
    note(found, PlausibilityCheck::quiet_angle, ticks / (row.looks - 0.5), GateFault::encoder_frozen,
         static_cast<int>(i));
  }
}

/// Takes a reading in; returns how the rates have changed [rad/s], empty where that is not known.
JointVector take(AngleMonitor& watch, const PlausibilityTick& tick) {
  const double interval = to_seconds(tick.joints.acquired - watch.acquired);
  const bool goes_on = watch.readings > 0 && interval < 1.5 * tick.T();
  if (!goes_on) watch.readings = watch.residuals = 0;
  const JointVector& last = watch.angle.back();
  JointVector angle = tick.joints.active;
  if (goes_on) angle = last + tick.robot.drive_difference(angle, last);
  push(watch.angle, angle);
  push(watch.interval, interval);
  watch.acquired = tick.joints.acquired;
  watch.readings = std::min(watch.readings + 1, 4);
  if (watch.readings < 3) return {};
  const auto& [a, b, c, d] = watch.angle;
  return (d - c) / watch.interval[3] - (c - b) / watch.interval[2];
}

}  // namespace

double AngleMonitor::angle_noise(Eigen::Index drive, const PlausibilityTick& tick) const noexcept {
  return change.deviation(drive, 0.1 * tick.limits.drive_acceleration * tick.T()) * tick.T() / std::sqrt(6.0);
}

bool AngleMonitor::is_noisy(Eigen::Index drive, const PlausibilityTick& tick) const noexcept {
  return change.deviation(drive, 0.0) > 0.5 * 0.1 * tick.limits.drive_acceleration * tick.T();
}

JointVector AngleMonitor::rates() const noexcept {
  if (readings < 3) return {};
  return (angle[3] - angle[1]) / (interval[3] + interval[2]);
}

Time AngleMonitor::rates_at() const noexcept { return acquired - from_seconds(interval[3]); }

void advance(AngleMonitor& watch, const PlausibilityTick& tick, const JointVector& torque,
             Plausibility& found) noexcept {
  if (!is_new_reading(watch, tick)) return;
  const JointVector change = take(watch, tick);
  if (change.size() == 0) return;
  if (tick.held) {
    watch.change.add(change);
    watch.residuals = 0;
  }
  if (watch.readings == 4) judge_quiet(watch, tick, found);
  const JointVector driven = tick.free ? drive_acceleration(tick, torque) : JointVector();
  if (driven.size() == 0) {
    watch.residuals = 0;
    return;
  }
  push(watch.residual, (change - 0.5 * (watch.interval[3] + watch.interval[2]) * driven).eval());
  watch.residuals = std::min(watch.residuals + 1, 3);
  judge_change(watch, tick, found);
}

}  // namespace flinch
