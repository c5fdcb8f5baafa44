#pragma once

#include <netinet/in.h>

#include <array>
#include <cstdint>

/// Listens to what this program sends to the network, as somebody on the wire would.
namespace flinch::test {

/// A datagram as it was sent.
struct Datagram {
  sockaddr_in to{};
  std::uint32_t size = 0;
  std::array<std::uint8_t, 1500> bytes{};
};

/// From now on each datagram of this program also goes into `pipe`, which must not block; what does not fit
/// is dropped.
void capture_datagrams(int pipe);

}  // namespace flinch::test
