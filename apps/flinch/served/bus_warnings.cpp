#include "apps/flinch/served/bus_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "drivers/dds_reader.h"
#include "drivers/robot_id.h"

namespace flinch {

std::string BusWarnings::news() {
  const Time now = MonotonicClock::now();
  if (now < next_look_) return "";
  next_look_ = now + 1s;
  return news_of_robots() + news_of(ask_());
}

std::string BusWarnings::news_of_robots() {
  const int robots = writers_on(bus_, status_topic);
  if (robots <= std::exchange(robots_, robots)) return "";
  return fmt::format(
      "warning: {} robots are on this bus; who commands one must choose it with --robot; this is {}\n",
      robots, robot_id_text(robot_id_));
}

std::string BusWarnings::news_of(const Commanders& commanders) {
  std::string news;
  if (commanders.other_pace > 0 && !std::exchange(told_pace_, true)) {
    news =
        pace_ == Pace::lockstep
            ? "warning: a program commands by the clock, and is not obeyed, for this robot goes in lockstep; "
              "start it with --lockstep, or this with --real-time\n"
            : "warning: a program commands in lockstep, and is not obeyed, for this robot goes by the clock; "
              "start it with --real-time, or this with --lockstep\n";
  }
  // A program that has just joined is not understood for an instant.
  const int lasting = std::min(std::exchange(unreadable_, commanders.unreadable), commanders.unreadable);
  if (lasting <= std::exchange(told_unreadable_, lasting)) return news;
  return news +
         "warning: a program commands in another version of the protocol, and is not obeyed; build both "
         "ends from the same flinch\n";
}

}  // namespace flinch
