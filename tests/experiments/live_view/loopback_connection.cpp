#include "tests/experiments/live_view/loopback_connection.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace flinch {

LoopbackConnection::LoopbackConnection(int port, int receives) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
  if (receives > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receives, sizeof receives);
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(static_cast<std::uint16_t>(port));
  there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0)
    throw std::runtime_error("nobody listens on port " + std::to_string(port));
}

LoopbackConnection::~LoopbackConnection() { close(socket_); }

void LoopbackConnection::send(const std::string& text) const {
  if (::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("the other end takes nothing");
}

std::string LoopbackConnection::read_until(const std::string& text, std::chrono::milliseconds longest) {
  const auto end = std::chrono::steady_clock::now() + longest;
  std::string all;
  while ((text.empty() || all.find(text) == std::string::npos) && std::chrono::steady_clock::now() < end) {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, 50) <= 0) continue;
    std::array<char, 65536> buffer{};
    const ssize_t count = recv(socket_, buffer.data(), buffer.size(), 0);
    if (count <= 0) break;
    all.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return all;
}

std::string LoopbackConnection::read_all() { return read_until(""); }

LiveAddress::LiveAddress(const std::string& address) {
  const std::string scheme = "http://";
  const std::size_t slash = address.find('/', scheme.size());
  host = address.substr(scheme.size(), slash - scheme.size());
  port = std::stoi(host.substr(host.find(':') + 1));
  root = address.substr(slash);
}

std::string answer(const LiveAddress& address, const std::string& first, const std::string& host,
                   const std::string& more) {
  LoopbackConnection connection(address.port);
  connection.send(first + " HTTP/1.1\r\nHost: " + host + "\r\n" + more +
                  (more.find("\r\n\r\n") == std::string::npos ? "\r\n" : ""));
  return connection.read_all();
}

}  // namespace flinch
