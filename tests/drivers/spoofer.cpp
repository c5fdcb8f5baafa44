#include "tests/drivers/spoofer.h"

#include <drivers/idl/flinch.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <deque>
#include <span>

#include "drivers/wire_header.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/drivers/link_ends.h"

namespace flinch::test {
namespace {

// DDSI-RTPS 2.3, 8.3 and 9.4: a header of 20 bytes, then submessages, each with 4 bytes of kind, flags and
// length.
constexpr std::size_t rtps_header = 20;
constexpr std::size_t submessage_header = 4;
constexpr std::uint8_t destination = 0x0e, data = 0x15, security_prefix = 0x31, security_postfix = 0x32;
constexpr std::size_t sequence_number = 4 + 12;  // its low word, within a data submessage

using Bytes = std::vector<std::uint8_t>;

template <class T>
T read(const Bytes& bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

template <class T>
void write(Bytes& bytes, std::size_t at, const T& value) {
  if (at + sizeof(T) <= bytes.size()) std::memcpy(bytes.data() + at, &value, sizeof(T));
}

/// Where the submessages begin, and the end.
std::vector<std::size_t> submessages(const Bytes& bytes) {
  std::vector<std::size_t> starts = {rtps_header};
  while (starts.back() + submessage_header <= bytes.size()) {
    const std::size_t length = read<std::uint16_t>(bytes, starts.back() + 2);
    const bool is_last = length == 0;
    starts.push_back(is_last ? bytes.size() : starts.back() + submessage_header + length);
  }
  return starts;
}

/// Where the torque command is, by the robot in its header; 0 for nowhere.
std::size_t command_in(const Bytes& bytes) {
  for (std::size_t at = rtps_header; at + sizeof(flinch_TorqueSample) <= bytes.size(); at += 4) {
    const auto sample = read<flinch_TorqueSample>(bytes, at);
    if (sample.header.robot == link_robot && sample.header.version == protocol_version) return at;
  }
  return 0;
}

Bytes bytes_of(const Datagram& datagram) {
  return {datagram.bytes.begin(), datagram.bytes.begin() + datagram.size};
}

Bytes without_protection(const Bytes& bytes) {
  Bytes kept(bytes.begin(), bytes.begin() + rtps_header);
  const std::vector<std::size_t> starts = submessages(bytes);
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    const std::uint8_t kind = bytes[starts[i]];
    if (kind == security_prefix || kind == security_postfix || starts[i + 1] > bytes.size()) continue;
    kept.insert(kept.end(), bytes.begin() + static_cast<std::ptrdiff_t>(starts[i]),
                bytes.begin() + static_cast<std::ptrdiff_t>(starts[i + 1]));
  }
  return kept;
}

/// Far ahead of the writer, so that it never catches up.
void number_anew(Bytes& bytes, std::uint32_t count) {
  for (const std::size_t start : submessages(bytes)) {
    if (start + submessage_header > bytes.size() || bytes[start] != data) continue;
    write(bytes, start + sequence_number, 1'000'000 + count);
  }
}

void send(int socket, const Bytes& bytes, const sockaddr_in& to, std::atomic<std::uint32_t>& count) {
  const auto* const address = reinterpret_cast<const sockaddr*>(&to);
  const ssize_t sent = ::sendto(socket, bytes.data(), bytes.size(), 0, address, sizeof(to));
  if (sent == static_cast<ssize_t>(bytes.size())) ++count;
}

}  // namespace

std::vector<std::uint8_t> forged(const Datagram& sent, std::uint32_t count, bool protection,
                                 std::uint64_t robot_id) {
  Bytes bytes = protection ? bytes_of(sent) : without_protection(bytes_of(sent));
  const std::size_t at = command_in(bytes);
  if (at == 0) return {};
  auto sample = read<flinch_TorqueSample>(bytes, at);
  sample.torque[0] = spoofed_torque;
  if (robot_id != 0) sample.header.robot_id = robot_id;
  sample.header.count = 3;
  sample.header.flags =
      count % 64 < 4 ? 0 : flag_valid;  // begins anew in case that the robot has given it up
  sample.header.sent_ns = MonotonicClock::now().count();
  sample.header.number = 1'000'000 + count;
  write(bytes, at, sample);
  number_anew(bytes, count);
  return bytes;
}

std::vector<std::uint8_t> renumbered(const Datagram& sent, std::uint32_t count) {
  Bytes bytes = bytes_of(sent);
  number_anew(bytes, count);
  return bytes;
}

std::vector<std::uint8_t> addressed_to_anybody(std::vector<std::uint8_t> packet) {
  const std::array<std::uint8_t, 12> any_participant{};
  constexpr std::uint32_t any_reader = 0;
  for (const std::size_t start : submessages(packet)) {
    if (start + submessage_header > packet.size()) continue;
    if (packet[start] == destination) write(packet, start + submessage_header, any_participant);
    if (packet[start] == data) write(packet, start + submessage_header + 4, any_reader);
  }
  return packet;
}

void spoof(int pipe, Spoofing& spoofing) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  std::uint32_t count = 0;
  Datagram datagram;
  while (::read(pipe, &datagram, sizeof(datagram)) == sizeof(datagram)) {
    const Bytes stripped = forged(datagram, ++count, false);
    if (stripped.empty()) continue;
    ++spoofing.captured;
    if (!spoofing.go) continue;
    send(socket, bytes_of(datagram), datagram.to, spoofing.replayed);
    send(socket, renumbered(datagram, ++count), datagram.to, spoofing.renumbered);
    send(socket, forged(datagram, ++count, true), datagram.to, spoofing.forged);
    send(socket, forged(datagram, ++count, false), datagram.to, spoofing.stripped);
  }
  ::_exit(1);
}

}  // namespace flinch::test
