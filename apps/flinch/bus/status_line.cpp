#include "apps/flinch/bus/status_line.h"

#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <utility>

namespace flinch {

StatusLine::StatusLine(std::function<Tidings()> ask, bool quiet)
    : ask_(std::move(ask)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      thread_([this](const std::stop_token& ending) { run(ending); }) {}

StatusLine::~StatusLine() {
  thread_.request_stop();
  thread_.join();
  if (!quiet_ && terminal_) fmt::print(stderr, "\r\x1b[K");
}

void StatusLine::run(const std::stop_token& ending) {
  while (!ending.stop_requested()) {
    tell(ask_());
    std::this_thread::sleep_for(std::chrono::milliseconds(terminal_ ? 100 : 20));
  }
  tell(ask_());
}

void StatusLine::tell(const Tidings& now) {
  if (quiet_) return;
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K{}  {}", now.state, now.figures);
    std::fflush(stderr);
  } else if (now.state != last_state_) {
    fmt::print(stderr, "{}  {}\n", now.state, now.figures);
  }
  last_state_ = now.state;
}

}  // namespace flinch
