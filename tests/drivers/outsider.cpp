#include "tests/drivers/outsider.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <vector>

#include "systems/framework/monotonic_clock.h"
#include "tests/support/two_networks.h"

namespace flinch::test {
std::vector<Datagram> overheard(int pipe, std::uint32_t domain) {
  const std::uint32_t discovery = 7410 + 250 * domain, samples = discovery + 1;  // DDSI-RTPS 2.3, 9.6.1.1
  std::vector<Datagram> kept;
  Datagram datagram;
  for (int commands = 0; commands < 300 && ::read(pipe, &datagram, sizeof(datagram)) == sizeof(datagram);) {
    const std::uint32_t port = ntohs(datagram.to.sin_port);
    if (port != discovery && port != samples) continue;
    commands += forged(datagram, 0, true).empty() ? 0 : 1;
    kept.push_back(datagram);
  }
  return kept;
}

Outsider::Outsider() {
  if (::pipe(ends) == 0) ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
}

void Outsider::overhear() const {
  while (!rehearses) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  capture_datagrams(ends[1]);
}

void Outsider::attack_from(const std::string& network, const std::string& address, std::uint32_t domain) {
  const std::vector<Datagram> heard = overheard(ends[0], domain);
  heard_enough = true;
  if (!enter_network(network)) ::_exit(1);
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  while (!go) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  for (std::uint32_t count = 0;;) {
    for (Datagram datagram : heard) {
      ::inet_pton(AF_INET, address.c_str(), &datagram.to.sin_addr);
      const std::vector<std::uint8_t> torque = forged(datagram, ++count, true, robot_id);
      const std::vector<std::uint8_t> packet = addressed_to_anybody(
          torque.empty()
              ? std::vector<std::uint8_t>(datagram.bytes.begin(), datagram.bytes.begin() + datagram.size)
              : torque);
      const auto* const to = reinterpret_cast<const sockaddr*>(&datagram.to);
      if (::sendto(socket, packet.data(), packet.size(), 0, to, sizeof(datagram.to)) > 0) ++sent;
      if (count % 16 == 0) MonotonicClock::sleep_until(MonotonicClock::now() + 100us);
    }
  }
}

bool Outsider::wait_until_heard_enough() const {
  for (int i = 0; i < 6000 && !heard_enough; ++i) {
    MonotonicClock::sleep_until(MonotonicClock::now() + 10ms);
  }
  return heard_enough;
}

}  // namespace flinch::test
