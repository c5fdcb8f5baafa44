#include "tests/drivers/free_domain.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace flinch::test {
namespace {

bool is_free(std::uint32_t port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  const bool free = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  ::close(socket);
  return free;
}

/// The unicast ports of participants 0 and 1. DDSI-RTPS, 9.6.1.1.
bool is_unused(std::uint32_t domain) {
  const std::uint32_t base = 7400 + 250 * domain;
  return is_free(base + 10) && is_free(base + 11) && is_free(base + 12) && is_free(base + 13);
}

}  // namespace

std::uint32_t free_domain() {
  constexpr std::uint32_t domains = 100;  // above, the ports are those that the kernel hands out
  const auto start = static_cast<std::uint32_t>(::getpid());
  for (std::uint32_t i = 0; i < domains; ++i) {
    const std::uint32_t domain = 1 + (start + i) % domains;
    if (is_unused(domain)) return domain;
  }
  throw std::runtime_error("every domain of the bus is in use on this machine");
}

}  // namespace flinch::test
