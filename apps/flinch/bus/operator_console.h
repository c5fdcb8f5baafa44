#pragma once

#include <signal.h>
#include <termios.h>

#include <array>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "experiments/bus/run_status.h"

namespace flinch {

class LiveRun;
struct OperatorOrder;
struct Scenario;

/// Hands the lines that an operator types to a run, as orders; read from stdin on a thread of its own. Others
/// may hand it lines as well. The end of stdin ends the run. Where stdin and stderr are a terminal, what is
/// typed is not shown by that but told by tell().
class OperatorConsole {
 public:
  /// Both must outlive this. `quiet`: only problems are said, and what the operator asks for.
  OperatorConsole(const Scenario& scenario, LiveRun& run, bool quiet);
  OperatorConsole(const OperatorConsole&) = delete;
  OperatorConsole& operator=(const OperatorConsole&) = delete;
  ~OperatorConsole();

  /// Gives the order of a line, and says so. False: it is none, or too many wait. Of any thread.
  bool follow(std::string_view line);
  /// Adds what is typed, and what is to be said since the last call.
  void tell(RunStatus& now);

 private:
  void read_until(const std::stop_token& ending);
  bool escapes(char letter);
  void take(char letter);
  void say(const std::string& lines);
  void end_run();
  bool give(const OperatorOrder& order);

  const Scenario& scenario_;
  LiveRun& run_;
  bool quiet_;
  std::optional<termios> terminal_;  ///< as it was; none: what is typed is not told
  enum class Escape { none, begun, function_key, arrow_key } escape_ = Escape::none;
  std::string problem_;                         ///< with the line so far
  std::array<struct sigaction, 2> handlers_{};  ///< of the signals of a terminal, as they were
  std::mutex mutex_;
  std::string line_;  ///< guarded by mutex_, as what follows
  std::string said_;
  std::mutex orders_;    ///< one order at a time
  std::jthread thread_;  // last
};

}  // namespace flinch
