#pragma once

#include "systems/safety/imu_monitor.h"

namespace flinch {

/// The motions in a row, one for each look.
struct TickMotions : Series<TickMotion, ImuMonitor::kept> {
  TickMotions(const ImuMonitor::Motions& ring, const ImuMonitor::Motions::Past& past,
              const PlausibilityTick& tick)
      : Series(ring, past),
        period(tick.period),
        T(tick.T()),
        wide(tick.looks(6ms, 2)),
        narrow(tick.looks(3ms)),
        most_ahead(tick.looks(4ms)),
        vote(tick.looks(6ms)) {}

  Time period;
  double T;
  int wide, narrow;  ///< of parabolas, to either side
  int most_ahead;    ///< motions after the instant of a sample that count
  int vote;          ///< over which encoders and unit are compared with the model
};

/// Where in the motions a time lies: `age` is that of the last before it, from which it is `share` of a tick.
struct TickPlace {
  std::size_t age = 1;
  double share = 0.0;
};
inline TickPlace place_of(const TickMotions& motions, Time time) {
  TickPlace place;
  while (place.age + 1 < motions.held() && motions.back(place.age).time > time) ++place.age;
  const Time before = motions.back(place.age).time;
  if (before < time && place.age >= 2) place.share = to_seconds(time - before) / motions.T;
  return place;
}

/// The step in the tick that begins at a place, which is one at least before the latest.
inline Padded<max_dof> step_from(const TickMotions& motions, const TickPlace& place) {
  const Padded<max_dof>& step = motions.back(place.age - 1).step;
  if (place.share == 0.0) return step;
  return step + place.share * (motions.back(place.age - 2).step - step);
}

/// By how much the step from `later` is larger than that from `earlier`, beyond what the drives make of it:
/// in the tick before a motion they give its acceleration, so the steps around one differ by the mean of two.
inline Padded<max_dof> unexplained_change(const TickMotions& motions, const TickPlace& earlier,
                                          const TickPlace& later) {
  const auto bend = [&motions](std::size_t age) -> Padded<max_dof> {  // of the steps that meet in age + 1
    const TickMotion &after = motions.back(age), &before = motions.back(age + 1);
    return after.step - before.step -
           0.5 * motions.T * motions.T * (after.acceleration + before.acceleration);
  };
  Padded<max_dof> change = Padded<max_dof>::Zero();
  for (std::size_t age = later.age - 1; age + 1 < earlier.age; ++age) change += bend(age);
  if (later.share > 0.0) change += later.share * bend(later.age - 2);
  if (earlier.share > 0.0) change -= earlier.share * bend(earlier.age - 2);
  return change;
}

}  // namespace flinch
