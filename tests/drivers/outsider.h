#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/drivers/spoofer.h"

namespace flinch::test {

/// What goes to the first participant of the domain, as it comes out of `pipe`, until there are 300 torque
/// commands in it.
std::vector<Datagram> overheard(int pipe, std::uint32_t domain);

/// Somebody who knows how flinch's programs talk, from having listened to some at home, and sends the same to
/// a robot of which he has received nothing. Shared by the programs that play the parts.
struct Outsider {
  static constexpr std::uint32_t enough = 100'000;  ///< packets

  std::atomic<bool> rehearses = false;  ///< a robot is there whose controller can be overheard
  std::atomic<bool> heard_enough = false;
  std::atomic<bool> go = false;
  std::atomic<std::uint64_t> robot_id = 0;  ///< of the robot to attack, which somebody has told him
  std::atomic<std::uint32_t> sent = 0;
  int ends[2] = {-1, -1};  ///< of a pipe: what is overheard

  Outsider();

  /// From now on what this program sends is overheard; waits until a robot is there to hear it.
  void overhear() const;
  /// Listens to a rehearsal on the bus `domain` of this machine; then goes to `network` and sends what it has
  /// heard, with torques of its own, to the robot at `address`. Never ends.
  [[noreturn]] void attack_from(const std::string& network, const std::string& address, std::uint32_t domain);
  /// Whether there is enough to send, after 60 s at most.
  bool wait_until_heard_enough() const;
};

}  // namespace flinch::test
