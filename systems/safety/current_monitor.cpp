#include "systems/safety/current_monitor.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace flinch {
namespace {

template <class Ring, class Value>
void push(Ring& ring, const Value& value) {
  std::move(ring.begin() + 1, ring.end(), ring.begin());
  ring.back() = value;
}

/// By how much a current lies outside of what was commanded lately [A].
double outside(std::span<const JointVector> commanded, Eigen::Index drive, double current) {
  double low = commanded.front()[drive], high = low;
  for (const JointVector& command : commanded) {
    low = std::min(low, command[drive]);
    high = std::max(high, command[drive]);
  }
  return std::max({low - current, current - high, 0.0});
}

bool all_commanded(std::span<const JointVector> commanded, int drives) {
  return std::all_of(commanded.begin(), commanded.end(),
                     [drives](const JointVector& command) { return command.size() == drives; });
}

/// The commands of the last 6 ms: so long a current may take.
std::span<const JointVector> lately_commanded(const CurrentMonitor& watch, const PlausibilityTick& tick) {
  return std::span(watch.commanded).last(static_cast<std::size_t>(tick.looks(6ms, 2)));
}

/// Three looks in a row, or those of 2 ms and one more: the least of them counts.
void judge_tube(CurrentMonitor& watch, const PlausibilityTick& tick, Plausibility& found) {
  const PlausibilityLimits& limits = tick.limits;
  const std::span<const JointVector> commanded_lately = lately_commanded(watch, tick);
  const bool asked = tick.free && limits.commands_act && all_commanded(commanded_lately, tick.robot.drives());
  const bool two_are_enough = tick.looks(2ms) < 2;
  for (Eigen::Index i = 0; i < tick.robot.drives(); ++i) {
    auto& before = watch.outside[static_cast<std::size_t>(i)];
    double ratio = 0.0;
    if (asked) {
      const double current = tick.drives.current[i];
      const double commanded = watch.commanded.back()[i];
      const double noise = limits.current_noise * watch.noise.deviation(i, 0.0);
      const double limit = std::max(limits.current, noise) +
                           limits.current_scale * std::max(std::abs(current), std::abs(commanded));
      ratio = outside(commanded_lately, i, current) / limit;
    }
    const double earliest = two_are_enough ? before[1] : before[0];
    note(found, PlausibilityCheck::tube, std::min({earliest, before[1], ratio}),
         GateFault::drive_not_following, static_cast<int>(i));
    before = {before[1], ratio};
  }
}

void judge_quiet(CurrentMonitor& watch, const PlausibilityTick& tick, Plausibility& found) {
  const auto& [a, b, c, d] = watch.measured;
  const JointVector third = d - 3.0 * c + 3.0 * b - a;
  if (tick.held) watch.third.add(third);
  const QuietRow row = quiet_row(tick.limits, tick.period);
  for (Eigen::Index i = 0; i < third.size(); ++i) {
    int& ticks = watch.quiet[static_cast<std::size_t>(i)];
    const double noise = watch.third.deviation(i, 0.0);
    ticks = watch.is_noisy(i, tick) && std::abs(third[i]) < row.share * noise ? ticks + 1 : 0;
    note(found, PlausibilityCheck::quiet_current, ticks / (row.looks - 0.5), GateFault::drive_not_following,
         static_cast<int>(i));
  }
}

}  // namespace

bool CurrentMonitor::is_noisy(Eigen::Index drive, const PlausibilityTick& tick) const noexcept {
  return third.deviation(drive, 0.0) > 0.1 * tick.limits.current;
}

void advance(CurrentMonitor& watch, const PlausibilityTick& tick, Plausibility& found) noexcept {
  const JointVector& current = tick.drives.current;
  if (!tick.drives.valid || current.size() != tick.robot.drives() || !current.allFinite()) {
    watch.readings = 0;
    return;
  }
  if (tick.limits.torque_constant.size() == 0) return;
  if (watch.readings > 0 && tick.drives.acquired <= watch.acquired) return;
  if (tick.drives.acquired - watch.acquired > 3 * tick.period / 2) watch.readings = 0;
  watch.acquired = tick.drives.acquired;
  push(watch.measured, current);
  watch.readings = std::min(watch.readings + 1, 4);
  if (tick.held) watch.noise.add(current);
  judge_tube(watch, tick, found);
  if (watch.readings == 4) judge_quiet(watch, tick, found);
}

void command(CurrentMonitor& watch, const PlausibilityLimits& limits, const TorqueCommand& torque) noexcept {
  const bool asked = torque.valid && torque.torque.size() == limits.torque_constant.size();
  push(watch.commanded,
       asked ? JointVector(torque.torque.cwiseQuotient(limits.torque_constant)) : JointVector());
}

}  // namespace flinch
