#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "systems/framework/time.h"
#include "tests/fault/link/bus_tap.h"

/// What the samples on a bus tell of how fast its two ends react. All by the stamps of who sends.
namespace flinch::test {

/// How long a reaction took, and how late the program was meanwhile that had to react: how much longer than a
/// tick it was silent. That is the machine's part.
struct Latency {
  Time value{};
  Time lateness{};
};

/// The longest silence of a session, or of all, between two samples of a range, beyond a tick.
template <class Sample>
Time lateness(const Track<Sample>& track, std::uint32_t begin, std::uint32_t end, std::uint32_t session = 0) {
  constexpr Time tick = 1ms;
  Time longest = tick;
  Time last{};
  for (std::uint32_t i = begin > 0 ? begin - 1 : 0; i < end; ++i) {
    if (session != 0 && track[i].header.session != session) continue;
    const Time sent(track[i].header.sent_ns);
    if (last != Time::zero()) longest = std::max(longest, sent - last);
    last = sent;
  }
  return longest - tick;
}

/// Where a log ends now.
struct LogEnd {
  explicit LogEnd(const BusLog& log) : status(log.status.count), commands(log.commands.count) {}
  std::uint32_t status;
  std::uint32_t commands;
};

/// From the sending of the last command that the robot obeyed to the first status after `begin` that says
/// that its brakes are closed. None before there is one.
std::optional<Latency> brakes_closed(const BusLog& log, const LogEnd& begin);

/// From `last_good` to the first command after `begin` of no torque and closed brakes.
std::optional<Latency> safe_command(const BusLog& log, const LogEnd& begin, Time last_good);

/// When the last joint reading before `time` was sent.
Time last_reading_before(const BusLog& log, Time time);

/// Whether the brakes are open in some status from `first` on.
bool opens_brakes(const BusLog& log, std::uint32_t first);

/// Whether a command asks for no torque and closed brakes.
bool is_safe(const flinch_TorqueSample& command);

}  // namespace flinch::test
