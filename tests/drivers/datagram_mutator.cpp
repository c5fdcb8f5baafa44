#include "tests/drivers/datagram_mutator.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "systems/framework/monotonic_clock.h"

namespace flinch::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t longest = 1500;  // of a datagram of a link
constexpr std::array<std::uint8_t, 9> extremes = {0x00, 0x01, 0x03, 0x04, 0x7f, 0x80, 0xfe, 0xff, 0x20};

std::size_t below(std::size_t count, std::mt19937_64& random) { return random() % count; }

void add_error(Bytes& bytes, std::mt19937_64& random) {
  if (bytes.empty()) bytes.push_back(0);
  const std::size_t at = below(bytes.size(), random);
  const std::size_t length = 1 + below(std::min<std::size_t>(32, bytes.size() - at), random);
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  switch (below(6, random)) {
    case 0:
      *place ^= static_cast<std::uint8_t>(1U << below(8, random));
      break;
    case 1:
      *place = static_cast<std::uint8_t>(random());
      break;
    case 2:  // a count, or a part of one
      std::fill_n(place, std::min<std::size_t>(length, below(2, random) == 0 ? 2 : 4),
                  extremes[below(extremes.size(), random)]);
      break;
    case 3:
      bytes.resize(at);
      break;
    case 4:
      for (std::size_t i = 0; i < length; ++i) bytes.push_back(static_cast<std::uint8_t>(random()));
      break;
    default: {
      const Bytes piece(place, place + static_cast<std::ptrdiff_t>(length));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size(), random)), piece.begin(),
                   piece.end());
    }
  }
  if (bytes.size() > longest) bytes.resize(longest);
}

/// The name of the sender stands in bytes 8 to 19 (DDSI-RTPS 2.3, 8.3.3.1).
void disown(Bytes& bytes) {
  for (std::size_t i = 8; i < std::min<std::size_t>(20, bytes.size()); ++i) bytes[i] = 0x5a;
}

}  // namespace

std::vector<std::uint8_t> mutant(const Datagram& sent, std::mt19937_64& random) {
  const Bytes original(sent.bytes.begin(), sent.bytes.begin() + sent.size);
  Bytes bytes = original;
  do {
    for (std::size_t errors = 1 + below(8, random); errors > 0; --errors) add_error(bytes, random);
  } while (bytes == original);
  return bytes;
}

void Mutants::send(const std::vector<Datagram>& heard, std::uint32_t count) {
  std::mt19937_64 random(20);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  while (!go) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  for (std::uint32_t number = 0; number < count; ++number) {
    const Datagram& original = heard[below(heard.size(), random)];
    Bytes bytes = mutant(original, random);
    const bool is_discovery = ntohs(original.to.sin_port) % 2 == 0;  // DDSI-RTPS 2.3, 9.6.1.1
    if (!is_discovery) disown(bytes);
    const auto* const to = reinterpret_cast<const sockaddr*>(&original.to);
    if (::sendto(socket, bytes.data(), bytes.size(), 0, to, sizeof(original.to)) >= 0) ++sent;
    if (number % 16 == 0) MonotonicClock::sleep_until(MonotonicClock::now() + 100us);
  }
  ::close(socket);
}

void Mutants::accompany(int pipe, int each) {
  std::mt19937_64 random(21);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  Datagram original;
  while (::read(pipe, &original, sizeof(original)) == sizeof(original)) {
    for (int i = 0; go && i < each; ++i) {
      const Bytes bytes = mutant(original, random);
      const auto* const to = reinterpret_cast<const sockaddr*>(&original.to);
      if (::sendto(socket, bytes.data(), bytes.size(), 0, to, sizeof(original.to)) >= 0) ++sent;
    }
  }
  ::_exit(1);
}

}  // namespace flinch::test
