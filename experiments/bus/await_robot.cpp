#include "experiments/bus/await_robot.h"

#include <fmt/core.h>

#include "drivers/bus_log.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {
namespace {

constexpr const char* other_version =
    "the robot speaks another version of the protocol; build both ends from the same flinch";

void throw_if_misunderstood(const DdsLink& link) {
  if (link.received > 0 || link.robots > 0) return;
  if (link.other_version > 0) {
    throw SetupError(other_version);
  }
  if (link.other_description > 0) {
    throw SetupError("the robot uses another robot description; give both ends the same robot file");
  }
}

/// Filters, limits and checks are made for one rate, and a controller that ticks more or less often than the
/// drives would see readings repeated or missing in turn.
void throw_if_other_rate(const DdsStation& station, Time of_robot) {
  const auto microseconds = [](Time time) { return 1e6 * to_seconds(time); };
  if (of_robot == station.period()) return;
  throw SetupError(fmt::format(
      "the robot runs with a control period of {0:g} us, and this program with {1:g} us; say "
      "'control_period_us: {0:g}' in the robot file or scenario of this end, or {1:g} at the other; nothing "
      "has moved",
      microseconds(of_robot), microseconds(station.period())));
}

/// Who would wait for the other, and who would not.
void throw_if_other_pace(DdsStation& station, const DdsLink& link) {
  if (link.other_pace == 0 || link.received > 0 || link.robot_id == 0) return;
  for (int i = 0; i < 3; ++i) {
    station.introduce();
    MonotonicClock::sleep_until(MonotonicClock::now() + 10ms);
  }
  throw SetupError(
      station.pace() == Pace::lockstep
          ? "the robot goes by the clock, and this program in lockstep, for which only a simulated robot can "
            "wait: start 'flinch serve' with --lockstep, or this without; nothing has moved"
          : "the robot goes in lockstep with its controller, and this program by the clock: start 'flinch "
            "serve' with --real-time, or 'flinch run' with --lockstep; nothing has moved");
}

std::string why_nothing_arrives(const DdsStation& station) {
  if (const auto robots = station.robots(); !robots.empty()) {
    return "the robot that --robot chooses does not send joint readings; these do: " + text_of(robots);
  }
  if (station.unreadable_robots() > 0) return other_version;
  if (refused_certificates() > 0) {
    return "somebody is there whose certificate was refused, as said above: keys of another authority, or "
           "not "
           "valid now; give both ends keys that 'flinch keys' made together";
  }
  if (station.peers() > 0) return "the robot is there, but none of its joint readings arrives";
  return "nobody sends joint readings there; start the robot's driver, or 'flinch serve' with the same "
         "--domain and --interface";
}

}  // namespace

void throw_if_interrupted(const InterruptCount& interrupts) {
  if (interrupts() > 0) throw SetupError("interrupted; nothing has moved");
}

void throw_if_undecided(const DdsStation& station) {
  if (!station.is_undecided()) return;
  const std::vector<SeenRobot> robots = station.robots();
  throw SetupError("there are " + std::to_string(robots.size()) + " robots on the bus: " + text_of(robots) +
                   "; choose one with --robot, by its name or its identity; nothing has moved");
}

bool await_robot(DdsStation& station, Time patience, const InterruptCount& interrupts) {
  const Time deadline = MonotonicClock::now() + patience;
  Time undecided_until = Time::max();  // so long, so that all are seen
  for (;;) {
    throw_if_interrupted(interrupts);
    const DdsLink link = station.link();
    throw_if_misunderstood(link);
    throw_if_other_pace(station, link);
    if (station.take_robot() != 0 && link.received > 0 && link.period > Time::zero()) {
      throw_if_other_rate(station, link.period);
      return true;
    }
    const Time now = MonotonicClock::now();
    if (!station.is_undecided()) undecided_until = Time::max();
    if (station.is_undecided() && undecided_until == Time::max()) undecided_until = now + 300ms;
    if (now > undecided_until) return false;
    if (now > deadline) throw SetupError(why_nothing_arrives(station));
    MonotonicClock::sleep_until(now + 10ms);
  }
}

void fall_into_step(DdsStation& station, ClockTicks& ticks) {
  constexpr Time readings_first = 300us;
  if (station.wait_for_joints(MonotonicClock::now() + 100ms)) {
    ticks.begin_at(MonotonicClock::now() + readings_first);
  }
}

}  // namespace flinch
