#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "drivers/bus_settings.h"

namespace flinch::test {

inline constexpr double intruders_torque = 99.0;  ///< no other sends it [Nm]

/// What an intruder got done.
struct Intrusion {
  std::atomic<std::uint64_t> robot_id = 0;  ///< of the robot that the commands are meant for, as it knows
  std::atomic<bool> is_on_bus = false;
  std::atomic<bool> has_writer = false;
  std::atomic<std::uint32_t> sent = 0;           ///< torque commands
  std::atomic<std::uint32_t> readings_seen = 0;  ///< joint samples
  std::atomic<std::uint32_t> commands_seen = 0;  ///< torque commands of others
  std::atomic<bool> is_heard = false;            ///< some reader takes its commands
};

/// Goes on the bus by Cyclone DDS alone, with or without keys, reads joint samples and torque commands, and
/// sends its own commands every millisecond: neutral ones, then `intruders_torque`. Never ends.
/// `access_control`: a plugin to use instead of the real one.
[[noreturn]] void intrude(const BusSettings& settings, const std::string& access_control,
                          Intrusion& intrusion);

}  // namespace flinch::test
