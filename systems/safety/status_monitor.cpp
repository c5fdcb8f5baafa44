#include "systems/safety/status_monitor.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr Time moving = 4ms;     // brakes that close on their own stop no robot sooner
constexpr double play = 50e-3;   // of closed brakes: what a drive at its resting rate moves meanwhile [s]
constexpr Time opening = 500ms;  // of slow brakes, and the way of the word that they are open
constexpr Time flutter = 20ms;   // of brakes that close for want of commands, and open with the next one

/// By how much the drives have moved since the station began to contradict its orders [rad or m].
double moved(const StatusMonitor& watch, const PlausibilityTick& tick) {
  const JointVector& now = tick.joints.active;
  if (!tick.joints.valid || now.size() == 0 || watch.angle.size() != now.size()) return 0.0;
  return tick.robot.drive_difference(now, watch.angle).lpNorm<Eigen::Infinity>();
}

void begin(StatusMonitor& watch, const PlausibilityTick& tick) {
  const bool seen = tick.joints.valid && tick.joints.active.size() == tick.robot.drives();
  watch.since = tick.now;
  watch.angle = seen ? tick.joints.active : JointVector();
  watch.moving = 0;
}

}  // namespace

void advance(StatusMonitor& watch, const StationStatus& status, bool engaged, const AngleMonitor& angles,
             const PlausibilityTick& tick, Plausibility& found) noexcept {
  if (engaged || !tick.limits.commands_act) {
    watch = StatusMonitor();
    return;
  }
  if (!status.valid) return;
  const bool against = status.braked;
  if (against && !watch.against) begin(watch, tick);
  watch.against = against;
  if (!against) {
    watch.opened = true;
    return;
  }
  const JointVector rates = tick.joints.valid ? angles.rates() : JointVector();
  const bool moves = rates.size() > 0 && rates.lpNorm<Eigen::Infinity>() > tick.limits.resting_rate;
  watch.moving = moves ? watch.moving + 1 : 0;
  const double most_looks = tick.looks(moving, 2) - 0.5;
  const double late = to_seconds(tick.now - watch.since) / to_seconds(watch.opened ? flutter : opening);
  const double shift = moved(watch, tick) / (play * tick.limits.resting_rate);
  note(found, PlausibilityCheck::status, std::max({watch.moving / most_looks, shift, late}),
       GateFault::status_contradicted);
}

}  // namespace flinch
