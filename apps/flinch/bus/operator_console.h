#pragma once

#include <termios.h>

#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "experiments/bus/tidings.h"

namespace flinch {

class LiveRun;
struct Scenario;

/// Hands the lines that an operator types to a run, as orders; read from stdin on a thread of its own. The
/// end of stdin ends the run. On a terminal what is typed is not shown by the terminal but told by tell().
class OperatorConsole {
 public:
  /// Both must outlive this. `quiet`: only problems are said, and what the operator asks for.
  OperatorConsole(const Scenario& scenario, LiveRun& run, bool quiet);
  OperatorConsole(const OperatorConsole&) = delete;
  OperatorConsole& operator=(const OperatorConsole&) = delete;
  ~OperatorConsole();

  /// Adds what is typed, and what is to be said since the last call.
  void tell(Tidings& now);

 private:
  void read_until(const std::stop_token& ending);
  void take(char letter);
  void follow(std::string_view line);
  void say(const std::string& lines);
  void end_run(const std::stop_token& ending);

  const Scenario& scenario_;
  LiveRun& run_;
  bool quiet_;
  std::optional<termios> terminal_;  ///< as it was; none: stdin is no terminal
  bool escapes_ = false;             ///< within what an arrow key sends
  bool is_too_long_ = false;         ///< the line
  std::mutex mutex_;
  std::string line_;  ///< guarded by mutex_, as what follows
  std::string said_;
  std::jthread thread_;  // last
};

}  // namespace flinch
