#pragma once

#include <functional>
#include <string>
#include <thread>

#include "experiments/bus/run_status.h"

namespace flinch {

/// Tells on stderr how a running program is, from a thread of its own: one line that redraws itself ten times
/// a second on a terminal, no wider than that; where stderr is a pipe or file, a plain line whenever the
/// state changes. When quiet nothing but what is said to an operator.
class StatusLine {
 public:
  /// `ask` is called on that thread, of ordinary priority, also when quiet.
  StatusLine(std::function<RunStatus()> ask, bool quiet);
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  /// Tells the last state and wipes the line.
  ~StatusLine();

 private:
  void run(const std::stop_token& ending);
  void tell(const RunStatus& now);

  std::function<RunStatus()> ask_;
  bool quiet_;
  bool terminal_;
  std::string last_state_;
  std::jthread thread_;  // last
};

}  // namespace flinch
