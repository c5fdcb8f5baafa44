#include "tests/drivers/datagram_capture.h"

#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>

namespace flinch::test {
namespace {

std::atomic<int> capturing = -1;

void keep(const msghdr& message, int pipe) {
  Datagram datagram;
  if (message.msg_namelen < sizeof(datagram.to)) return;
  std::memcpy(&datagram.to, message.msg_name, sizeof(datagram.to));
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const iovec& part = message.msg_iov[i];
    if (datagram.size + part.iov_len > datagram.bytes.size()) return;
    std::memcpy(datagram.bytes.data() + datagram.size, part.iov_base, part.iov_len);
    datagram.size += static_cast<std::uint32_t>(part.iov_len);
  }
  [[maybe_unused]] const ssize_t written = ::write(pipe, &datagram, sizeof(datagram));
}

}  // namespace

void capture_datagrams(int pipe) { capturing = pipe; }

}  // namespace flinch::test

/// Stands in for that of the C library, for the bus as well.
extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  const int pipe = flinch::test::capturing;
  if (pipe >= 0) flinch::test::keep(*message, pipe);
  return ::syscall(SYS_sendmsg, socket, message, flags);
}
