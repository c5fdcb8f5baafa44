#include "experiments/bus/await_robot.h"

#include "systems/foundation/setup_error.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {
namespace {

void throw_if_misunderstood(const DdsLink& link) {
  if (link.received > 0) return;
  if (link.other_version > 0) {
    throw SetupError(
        "the robot speaks another version of the protocol; build both ends from the same flinch");
  }
  if (link.other_robot > 0) {
    throw SetupError("the robot uses another robot description; give both ends the same robot file");
  }
}

}  // namespace

void throw_if_interrupted(const InterruptCount& interrupts) {
  if (interrupts() > 0) throw SetupError("interrupted; nothing has moved");
}

void await_robot(const DdsStation& station, Time patience, const InterruptCount& interrupts) {
  const Time deadline = MonotonicClock::now() + patience;
  for (DdsLink link = station.link(); link.received == 0; link = station.link()) {
    throw_if_interrupted(interrupts);
    throw_if_misunderstood(link);
    if (MonotonicClock::now() > deadline) {
      throw SetupError(station.peers() == 0
                           ? "nobody sends joint readings there; start the robot's driver, or 'flinch serve' "
                             "with the same --domain and --interface"
                           : "the robot is there, but none of its joint readings arrives");
    }
    MonotonicClock::sleep_until(MonotonicClock::now() + 10ms);
  }
}

void fall_into_step(DdsStation& station, ClockTicks& ticks) {
  constexpr Time readings_first = 300us;
  if (station.wait_for_joints(MonotonicClock::now() + 100ms)) {
    ticks.begin_at(MonotonicClock::now() + readings_first);
  }
}

}  // namespace flinch
