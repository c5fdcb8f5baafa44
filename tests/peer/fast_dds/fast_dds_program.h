#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace flinch::test {

/// The Fast DDS subscriber, a program of its own, while this lives.
class FastDdsProgram {
 public:
  FastDdsProgram(std::uint32_t domain, const char* reliability);
  FastDdsProgram(const FastDdsProgram&) = delete;
  FastDdsProgram& operator=(const FastDdsProgram&) = delete;
  ~FastDdsProgram();

  /// What has arrived there so far on a topic, each message as MessageText writes it.
  std::vector<std::string> messages(const std::string& topic) const;

 private:
  void read_lines();

  pid_t id_ = -1;
  int input_ = -1;   // of the program; it ends when this is closed
  int output_ = -1;  // of the program
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<std::string>> messages_;
  std::thread reader_;
};

}  // namespace flinch::test
