#include "apps/flinch/bus/operator_console.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <span>
#include <utility>

#include "apps/flinch/bus/ordinary_thread.h"
#include "experiments/bus/live_run.h"
#include "experiments/bus/operator_order.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t longest_line = 200;
constexpr char end_of_input = 4, backspace = 8, rub_out = 127, kill_line = 21, escape = 27;

/// How the terminal on stdin is; none where there is none.
std::optional<termios> settings_of_terminal() {
  termios now{};
  if (tcgetattr(STDIN_FILENO, &now) != 0) return std::nullopt;
  return now;
}

/// Letter by letter and unseen. A program that Ctrl-Z suspends would leave the robot alone.
termios unseen(termios settings) {
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  settings.c_cc[VSUSP] = _POSIX_VDISABLE;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  return settings;
}

bool is_printable(char letter) { return std::isprint(static_cast<unsigned char>(letter)) != 0; }

}  // namespace

OperatorConsole::OperatorConsole(const Scenario& scenario, LiveRun& run, bool quiet)
    : scenario_(scenario), run_(run), quiet_(quiet), terminal_(settings_of_terminal()) {
  for (const int signal : {SIGTTIN, SIGTTOU}) std::signal(signal, SIG_IGN);  // in the background, too
  if (terminal_) {
    const termios settings = unseen(*terminal_);
    tcsetattr(STDIN_FILENO, TCSANOW, &settings);
  }
  if (!quiet_) say("orders:    stop, reset, start, go, step, end; 'help' tells more\n");
  thread_ = std::jthread([this](const std::stop_token& ending) { read_until(ending); });
}

OperatorConsole::~OperatorConsole() {
  thread_.request_stop();
  thread_.join();
  if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &*terminal_);
  for (const int signal : {SIGTTIN, SIGTTOU}) std::signal(signal, SIG_DFL);
}

void OperatorConsole::tell(Tidings& now) {
  const std::lock_guard lock(mutex_);
  if (terminal_) now.typed = "> " + line_ + "  ";
  now.said = std::exchange(said_, {});
}

void OperatorConsole::say(const std::string& lines) {
  const std::lock_guard lock(mutex_);
  said_ += lines;
}

void OperatorConsole::end_run(const std::stop_token& ending) {
  while (!run_.give({.buttons = {}, .target = {}, .end = true}) && !ending.stop_requested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void OperatorConsole::read_until(const std::stop_token& ending) {
  become_ordinary_thread();
  while (!ending.stop_requested()) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, 50) <= 0) continue;
    std::array<char, 256> letters{};
    const ssize_t size = read(STDIN_FILENO, letters.data(), letters.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) return end_run(ending);
    for (const char letter : std::span(letters).first(static_cast<std::size_t>(size))) {
      if (terminal_ && letter == end_of_input) return end_run(ending);
      take(letter);
    }
  }
}

void OperatorConsole::take(char letter) {
  std::unique_lock lock(mutex_);
  if (escapes_) {
    escapes_ = std::isalpha(static_cast<unsigned char>(letter)) == 0 && letter != '~';
  } else if (letter == '\n' || letter == '\r') {
    const std::string line = std::exchange(line_, {});
    const bool is_too_long = std::exchange(is_too_long_, false);
    lock.unlock();
    if (is_too_long) return say("error: an order has at most " + std::to_string(longest_line) + " letters\n");
    follow(line);
  } else if (letter == escape) {
    escapes_ = true;
  } else if (letter == kill_line) {
    line_.clear();
  } else if (letter == backspace || letter == rub_out) {
    if (!line_.empty()) line_.pop_back();
  } else if (line_.size() == longest_line) {
    is_too_long_ = true;
  } else if (is_printable(letter) || letter == '\t') {
    line_ += letter == '\t' ? ' ' : letter;
  }
}

void OperatorConsole::follow(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string_view::npos) return;
  line = line.substr(begin, line.find_last_not_of(' ') + 1 - begin);
  if (line == "help") return say(std::string(known_orders()));
  try {
    if (!run_.give(read_order(line, scenario_))) return say("error: too many orders wait\n");
    if (!quiet_) say("ordered:   " + std::string(line) + "\n");
  } catch (const SetupError& error) {
    for (const std::string& problem : error.problems()) say("error: " + problem + "\n");
  }
}

}  // namespace flinch
