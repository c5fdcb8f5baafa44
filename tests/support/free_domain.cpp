#include "tests/support/free_domain.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <list>
#include <stdexcept>
#include <string>

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

/// A file that is locked by whoever has the domain, or is about to: its ports alone would be free until then.
/// It stays locked while this program or one that it has made by copying itself lives.
class Reservation {
 public:
  explicit Reservation(std::uint32_t domain) {
    const auto name = std::filesystem::temp_directory_path() / ("flinch_domain_" + std::to_string(domain));
    file_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    made_ = file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0;
  }
  Reservation(const Reservation&) = delete;
  Reservation& operator=(const Reservation&) = delete;
  ~Reservation() { ::close(file_); }

  bool made() const { return made_; }

 private:
  int file_ = -1;
  bool made_ = false;
};

}  // namespace

std::uint32_t free_domain() {
  // In 100 there is never a robot, in 101 that of an example; above, ports are those that the kernel gives.
  constexpr std::uint32_t domains = 99;
  static std::list<Reservation> ours;
  constexpr std::size_t most = 4;  // of one test; those of earlier tests of this program are given back
  if (ours.size() == most) ours.pop_front();
  const auto start = static_cast<std::uint32_t>(::getpid());
  for (std::uint32_t i = 0; i < domains; ++i) {
    const std::uint32_t domain = 1 + (start + i) % domains;
    ours.emplace_back(domain);
    if (ours.back().made() && is_unused(domain)) return domain;
    ours.pop_back();
  }
  throw std::runtime_error("every domain of the bus is in use on this machine");
}

}  // namespace flinch::test
