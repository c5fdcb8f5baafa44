#include "apps/flinch/bus/operator_console.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
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

constexpr std::array terminal_signals{SIGTTIN, SIGTTOU};  // that would hang a program in the background

/// How the terminal is that what is typed is read from and told on; none where there is none of our own.
std::optional<termios> settings_of_terminal() {
  termios now{};
  const bool is_ours = isatty(STDERR_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp();
  if (!is_ours || tcgetattr(STDIN_FILENO, &now) != 0) return std::nullopt;
  return now;
}

/// Letter by letter and unseen. A program that a key suspends or kills would leave the robot alone, and one
/// whose output a key stops could not end.
termios unseen(termios settings) {
  settings.c_iflag &= ~static_cast<tcflag_t>(IXON);
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  settings.c_cc[VSUSP] = settings.c_cc[VQUIT] = _POSIX_VDISABLE;
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  return settings;
}

bool is_printable(char letter) { return std::isprint(static_cast<unsigned char>(letter)) != 0; }
bool is_letter(char letter) { return std::isalpha(static_cast<unsigned char>(letter)) != 0; }

}  // namespace

OperatorConsole::OperatorConsole(const Scenario& scenario, LiveRun& run, bool quiet)
    : scenario_(scenario),
      run_(run),
      quiet_(quiet),
      terminal_(quiet ? std::nullopt : settings_of_terminal()) {
  struct sigaction ignored {};
  ignored.sa_handler = SIG_IGN;
  for (std::size_t i = 0; i < terminal_signals.size(); ++i)
    sigaction(terminal_signals.at(i), &ignored, &handlers_.at(i));
  if (terminal_) {
    const termios settings = unseen(*terminal_);
    tcsetattr(STDIN_FILENO, TCSAFLUSH, &settings);  // what was typed before is no order
  }
  if (!quiet_) say("orders:    stop, reset, start, go, step, end; 'help' tells more\n");
  thread_ = std::jthread([this](const std::stop_token& ending) { read_until(ending); });
}

OperatorConsole::~OperatorConsole() {
  thread_.request_stop();
  thread_.join();
  if (terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &*terminal_);
  for (std::size_t i = 0; i < terminal_signals.size(); ++i)
    sigaction(terminal_signals.at(i), &handlers_.at(i), nullptr);
}

void OperatorConsole::tell(RunStatus& now) {
  const std::lock_guard lock(mutex_);
  if (terminal_) now.typed = "> " + line_ + "  ";
  now.said = std::exchange(said_, {}) + now.said;
}

void OperatorConsole::say(const std::string& lines) {
  const std::lock_guard lock(mutex_);
  said_ += lines;
}

/// Who no longer can order shall not leave a robot that moves.
void OperatorConsole::end_run() {
  say("ended:     the end of the input\n");
  give({.buttons = {}, .target = {}, .end = true});
}

bool OperatorConsole::give(const OperatorOrder& order) {
  const std::lock_guard lock(orders_);
  return run_.give(order);
}

void OperatorConsole::read_until(const std::stop_token& ending) {
  become_ordinary_thread();
  while (!ending.stop_requested()) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, 50) <= 0) continue;
    std::array<char, 256> letters{};
    const ssize_t size = read(STDIN_FILENO, letters.data(), letters.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) return end_run();
    for (const char letter : std::span(letters).first(static_cast<std::size_t>(size))) {
      if (terminal_ && letter == end_of_input) return end_run();
      take(letter);
    }
  }
}

/// Whether the letter is part of what a key sends that has none: Esc [ ... or Esc O and a letter.
bool OperatorConsole::escapes(char letter) {
  switch (std::exchange(escape_, Escape::none)) {
    case Escape::begun:
      if (letter == '[') escape_ = Escape::arrow_key;
      if (letter == 'O') escape_ = Escape::function_key;
      return letter == '[' || letter == 'O';
    case Escape::function_key:
      return is_letter(letter);
    case Escape::arrow_key:
      if (!is_printable(letter)) return false;
      if (!is_letter(letter) && letter != '~') escape_ = Escape::arrow_key;
      return true;
    case Escape::none:
      break;
  }
  return false;
}

void OperatorConsole::take(char letter) {
  std::unique_lock lock(mutex_);
  if (escapes(letter)) return;
  if (letter == '\n' || letter == '\r') {
    const std::string line = std::exchange(line_, {}), problem = std::exchange(problem_, {});
    lock.unlock();
    if (problem.empty()) {
      follow(line);
    } else {
      say("error: " + problem + "\n");
    }
    return;
  }
  if (letter == escape && terminal_) {
    escape_ = Escape::begun;
  } else if (letter == kill_line) {
    line_.clear();
    problem_.clear();
  } else if (letter == backspace || letter == rub_out) {
    if (!line_.empty()) line_.pop_back();
  } else if (line_.size() == longest_line) {
    problem_ = "an order has at most " + std::to_string(longest_line) + " letters";
  } else if (is_printable(letter) || letter == '\t') {
    line_ += letter == '\t' ? ' ' : letter;
  } else {
    problem_ =
        "'" + line_ + "' is followed by a letter that no order has, as a minus that is none; type it anew";
  }
}

bool OperatorConsole::follow(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string_view::npos) return false;
  line = line.substr(begin, line.find_last_not_of(' ') + 1 - begin);
  if (!std::all_of(line.begin(), line.end(), is_printable)) {
    say("error: an order has a letter that none has\n");
    return false;
  }
  if (line == "help") {
    say(std::string(known_orders()));
    return true;
  }
  try {
    const bool is_given = give(read_order(line, scenario_));
    if (!is_given) say("error: too many orders wait\n");
    if (is_given && !quiet_) say("ordered:   " + std::string(line) + "\n");
    return is_given;
  } catch (const SetupError& error) {
    for (const std::string& problem : error.problems()) say("error: " + problem + "\n");
    return false;
  }
}

}  // namespace flinch
