#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace flinch::test {

/// The program flinch, running beside this one. What it prints goes to a file.
class OtherProgram {
 public:
  /// `output`: what takes its stdout and stderr.
  OtherProgram(const std::vector<std::string>& arguments, const std::string& output);
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;
  /// Kills it if it still runs.
  ~OtherProgram();

  void signal(int number) const;
  /// Waits for its end; its exit status, or 128 + the signal that ended it.
  int wait();

 private:
  pid_t id_ = -1;
};

}  // namespace flinch::test
