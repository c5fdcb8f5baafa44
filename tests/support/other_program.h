#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/time.h"

namespace flinch::test {

/// A program of its own beside this one. It dies with this, or with the thread that has made it.
class OtherProgram {
 public:
  /// How to start a program from a file.
  struct Start {
    std::vector<std::string> command;                ///< its file, then its arguments
    std::map<std::string, std::string> environment;  ///< that it has besides ours
    std::string preloaded;                           ///< a library that stands before all others
    std::function<bool()> prepare;  ///< what it does before; where that fails it ends with 127
    enum class Input { ours, pipe, terminal } input = Input::ours;  ///< a terminal shows stderr, too
  };

  explicit OtherProgram(const Start& start);
  /// A copy of this program, which calls `body` and ends. To be made before this one has threads, as on a
  /// bus: they do not survive the copying.
  explicit OtherProgram(const std::function<void()>& body);
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;
  /// Kills it if it still runs.
  ~OtherProgram();

  void kill();
  void stop();  ///< it hangs
  void resume();
  void interrupt();

  /// Writes to its input, which is a pipe or a terminal.
  void type(const std::string& text);
  /// Ends it.
  void end_input();
  /// Whether its terminal shows what is typed by itself.
  bool echoes() const;

  bool is_running();
  /// Its exit status; none if it still runs after `patience`, or was killed.
  std::optional<int> wait(Time patience);
  /// Whether it has written `text` by the end of `patience`, or before it ended.
  bool writes(const std::string& text, Time patience);
  /// What it has written so far to stdout and stderr; of a copy, nothing.
  std::string output() const;

 private:
  void send(int signal);

  pid_t id_ = 0;
  int output_ = -1;
  int input_ = -1;
  bool has_terminal_ = false;
  mutable std::string screen_;  ///< what the terminal has shown
  bool ended_ = false;
  int status_ = 0;
};

}  // namespace flinch::test
