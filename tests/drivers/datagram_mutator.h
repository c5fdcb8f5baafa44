#pragma once

#include <atomic>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/drivers/datagram_capture.h"

/// Somebody who sends datagrams of a link again with random errors in them.
namespace flinch::test {

/// The datagram with one to eight errors: bits, bytes, counts of two and four bytes, pieces that come twice,
/// or an end that is missing or too long. Never as it was.
std::vector<std::uint8_t> mutant(const Datagram& sent, std::mt19937_64& random);

/// What was sent; shared by the programs that play the parts.
struct Mutants {
  std::atomic<bool> go = false;
  std::atomic<std::uint32_t> sent = 0;

  /// Sends `count` mutants of what was `heard`, as soon as it is told to go. Samples come in the name of a
  /// participant that nobody knows: an error that leaves its torque whole would else be a good command.
  void send(const std::vector<Datagram>& heard, std::uint32_t count);
  /// Sends `each` mutants of each datagram that comes out of `pipe`, to where it went, in the name of who has
  /// sent it, as long as it is told to go. Never ends.
  [[noreturn]] void accompany(int pipe, int each);
};

}  // namespace flinch::test
