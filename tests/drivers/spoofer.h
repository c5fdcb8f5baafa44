#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "tests/drivers/datagram_capture.h"

/// Somebody on the wire, who makes packets of those that a controller sends.
namespace flinch::test {

inline constexpr double spoofed_torque = 77.0;  ///< no other sends it [Nm]

/// The same datagram with `spoofed_torque`, and now and then neutral, in the name of the same writer, newer
/// than anything it has sent; without `protection`, what DDS Security has put around the sample is taken off.
/// `count`: which forgery of that datagram's run it is; `robot_id`: of the robot that shall obey, 0: as it
/// was. Empty where there is no torque command in it.
std::vector<std::uint8_t> forged(const Datagram& sent, std::uint32_t count, bool protection,
                                 std::uint64_t robot_id = 0);

/// The same datagram with the same sample, that the bus takes for a new one.
std::vector<std::uint8_t> renumbered(const Datagram& sent, std::uint32_t count);

/// The packet for whoever gets it, not only for the participant and the reader that it names.
std::vector<std::uint8_t> addressed_to_anybody(std::vector<std::uint8_t> packet);

/// What was sent, each to where the original went.
struct Spoofing {
  std::atomic<bool> go = false;
  std::atomic<std::uint32_t> captured = 0;  ///< torque commands of the controller
  std::atomic<std::uint32_t> forged = 0;
  std::atomic<std::uint32_t> stripped = 0;  ///< forged without protection
  std::atomic<std::uint32_t> replayed = 0;  ///< as they were
  std::atomic<std::uint32_t> renumbered = 0;
};

/// Sends one of each kind for each datagram that comes out of `pipe`, as soon as it is told to go. Never
/// ends.
[[noreturn]] void spoof(int pipe, Spoofing& spoofing);

}  // namespace flinch::test
