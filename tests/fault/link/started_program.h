#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/time.h"

namespace flinch::test {

/// The flinch that is tested, as a program of its own, killed at the end if it still runs.
class StartedProgram {
 public:
  /// `network`: name of the network namespace to start it in; empty: ours.
  explicit StartedProgram(const std::vector<std::string>& arguments,
                          const std::map<std::string, std::string>& environment = {},
                          const std::string& network = "");
  StartedProgram(const StartedProgram&) = delete;
  StartedProgram& operator=(const StartedProgram&) = delete;
  ~StartedProgram();

  void kill();
  void stop();  ///< it hangs
  void resume();
  void interrupt();

  bool is_running();
  /// Its exit status; none if it still runs after `patience`, or was killed.
  std::optional<int> wait(Time patience);
  /// What it has written so far.
  std::string output() const;

 private:
  void send(int signal);
  bool has_ended();

  pid_t id_ = 0;
  int output_ = -1;
  bool ended_ = false;
  int status_ = 0;
};

/// Makes this process part of a network namespace. Returns whether that worked.
bool enter_network(const std::string& network);

}  // namespace flinch::test
