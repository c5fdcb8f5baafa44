#pragma once

#include <chrono>
#include <string>

namespace flinch {

/// A connection to a port of this computer, byte by byte: what it says is what the test wrote.
class LoopbackConnection {
 public:
  /// `receives`: bytes that the system may keep for who does not read; 0: as it likes.
  explicit LoopbackConnection(int port, int receives = 0);
  ~LoopbackConnection();
  LoopbackConnection(const LoopbackConnection&) = delete;
  LoopbackConnection& operator=(const LoopbackConnection&) = delete;

  void send(const std::string& text) const;
  /// All that comes until `text` has, or until the other end closes, or for so long.
  std::string read_until(const std::string& text,
                         std::chrono::milliseconds longest = std::chrono::seconds(20));
  /// All that comes until the other end closes.
  std::string read_all();

 private:
  int socket_;
};

/// An address "http://127.0.0.1:PORT/TOKEN/", taken to pieces.
struct LiveAddress {
  explicit LiveAddress(const std::string& address);
  std::string host;  ///< with the port
  int port = 0;
  std::string root;  ///< "/TOKEN/"
};

/// The answer to one request whose head is `first`, the header Host and `more` lines, each with its line end.
std::string answer(const LiveAddress& address, const std::string& first, const std::string& host,
                   const std::string& more = "");

}  // namespace flinch
