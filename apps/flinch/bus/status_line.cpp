#include "apps/flinch/bus/status_line.h"

#include <pthread.h>
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
  if (!quiet_ && terminal_) std::fputs("\r\x1b[K", stderr);
}

void StatusLine::run(const std::stop_token& ending) {
  const sched_param ordinary{};  // whoever made this may be in more of a hurry
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
  while (!ending.stop_requested()) {
    tell(ask_());
    std::this_thread::sleep_for(std::chrono::milliseconds(terminal_ ? 100 : 20));
  }
  tell(ask_());
}

void StatusLine::tell(const Tidings& now) {
  if (quiet_) return;
  const std::string line = now.state + "  " + now.figures;
  if (terminal_) {
    std::fputs(("\r\x1b[K" + line).c_str(), stderr);
    std::fflush(stderr);
  } else if (now.state != last_state_) {
    std::fputs((line + "\n").c_str(), stderr);
  }
  last_state_ = now.state;
}

}  // namespace flinch
