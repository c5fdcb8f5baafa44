#include "apps/flinch/bus/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "apps/flinch/bus/ordinary_thread.h"
#include "apps/flinch/printing.h"

namespace flinch {
namespace {

/// The end of what is typed, in half a line of the terminal at most, and as much of `line` as fits behind it;
/// all of both where the width is not known.
std::string fitting(std::string typed, const std::string& line) {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  if (is_known && typed.size() > size.ws_col / 2U) typed.erase(0, typed.size() - size.ws_col / 2U);
  typed += line;
  if (is_known && typed.size() >= size.ws_col) typed.resize(size.ws_col - 1U);
  return typed;
}

}  // namespace

StatusLine::StatusLine(std::function<RunStatus()> ask, bool quiet)
    : ask_(std::move(ask)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      thread_([this](const std::stop_token& ending) { run(ending); }) {}

StatusLine::~StatusLine() {
  thread_.request_stop();
  thread_.join();
  if (!quiet_ && terminal_) clear_line();
}

void StatusLine::run(const std::stop_token& ending) {
  become_ordinary_thread();
  while (!ending.stop_requested()) {
    tell(ask_());
    std::this_thread::sleep_for(std::chrono::milliseconds(terminal_ ? 100 : 20));
  }
  tell(ask_());
}

void StatusLine::tell(const RunStatus& now) {
  if (terminal_ && (!now.said.empty() || !now.noted.empty())) clear_line();
  print_messages(now.said);
  if (quiet_) return;
  print_messages(now.noted);
  const std::string line = now.state + "  " + now.figures;
  if (terminal_) {
    clear_line();
    print_messages(fitting(now.typed, line));
    flush_messages();
  } else if (now.state != last_state_) {
    print_messages(line + "\n");
  }
  last_state_ = now.state;
}

}  // namespace flinch
