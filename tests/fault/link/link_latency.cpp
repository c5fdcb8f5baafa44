#include "tests/fault/link/link_latency.h"

#include <algorithm>

#include "drivers/wire_header.h"

namespace flinch::test {
std::optional<Latency> brakes_closed(const BusLog& log, const LogEnd& begin) {
  const Track<flinch_StatusSample>& status = log.status;
  const std::uint32_t count = status.count;
  Time last_command{};
  const std::uint32_t first = begin.status > 50 ? begin.status - 50 : 0;
  for (std::uint32_t i = first; i < count; ++i) {
    if (i < begin.status || status[i].braked == 0) {
      last_command = std::max(last_command, Time(status[i].command_sent_ns));
      continue;
    }
    return Latency{Time(status[i].header.sent_ns) - last_command, lateness(status, begin.status, i + 1)};
  }
  return std::nullopt;
}

bool is_safe(const flinch_TorqueSample& command) {
  return (command.header.flags & flag_valid) == 0 && (command.header.flags & flag_engage_brake) != 0;
}

std::optional<Latency> safe_command(const BusLog& log, const LogEnd& begin, Time last_good) {
  const Track<flinch_TorqueSample>& commands = log.commands;
  const std::uint32_t count = commands.count;
  for (std::uint32_t i = begin.commands; i < count; ++i) {
    if (!is_safe(commands[i]) || Time(commands[i].header.sent_ns) < last_good) continue;
    return Latency{Time(commands[i].header.sent_ns) - last_good, lateness(commands, begin.commands, i + 1)};
  }
  return std::nullopt;
}

Time last_reading_before(const BusLog& log, Time time) {
  for (std::uint32_t i = log.joints.count; i > 0; --i) {
    const Time sent(log.joints[i - 1].header.sent_ns);
    if (sent < time) return sent;
  }
  return Time::zero();
}

bool opens_brakes(const BusLog& log, std::uint32_t first) {
  const std::uint32_t count = log.status.count;
  for (std::uint32_t i = first; i < count; ++i) {
    if (log.status[i].braked == 0) return true;
  }
  return false;
}

}  // namespace flinch::test
