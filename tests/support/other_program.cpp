#include "tests/support/other_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <thread>
#include <utility>

#include "systems/framework/monotonic_clock.h"

namespace flinch::test {
namespace {

/// A copy of this program that dies with it: 0 in the copy.
pid_t copy_of_this_program() {
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id != 0) return id;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it has died meanwhile
  return id;
}

/// Before whatever is preloaded into this program.
void preload(const std::string& library) {
  if (library.empty()) return;
  const char* const others = std::getenv("LD_PRELOAD");
  ::setenv("LD_PRELOAD", (others == nullptr ? library : library + ":" + others).c_str(), 1);
}

struct Ends {
  int here = -1, there = -1;
};

Ends ends_of(OtherProgram::Start::Input input) {
  using Input = OtherProgram::Start::Input;
  std::array<int, 2> pipe{-1, -1};
  if (input == Input::pipe && ::pipe2(pipe.data(), O_CLOEXEC) == 0)
    return {.here = pipe[1], .there = pipe[0]};
  if (input != Input::terminal) return {};
  const int here = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  ::grantpt(here);
  ::unlockpt(here);
  std::array<char, 64> name{};
  ::ptsname_r(here, name.data(), name.size());
  return {.here = here, .there = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC)};
}

}  // namespace

OtherProgram::OtherProgram(const Start& start) : output_(::memfd_create("output", MFD_CLOEXEC)) {
  const Ends input = ends_of(start.input);
  input_ = input.here;
  has_terminal_ = start.input == Start::Input::terminal;
  std::vector<char*> words;
  for (const std::string& word : start.command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  id_ = copy_of_this_program();
  if (id_ != 0) {
    if (input.there >= 0) ::close(input.there);
    return;
  }
  if (input.there >= 0) ::dup2(input.there, STDIN_FILENO);
  ::dup2(output_, STDOUT_FILENO);
  ::dup2(has_terminal_ ? input.there : output_, STDERR_FILENO);
  if (has_terminal_ && ::setsid() > 0) ::ioctl(input.there, TIOCSCTTY, 0);
  for (const auto& [name, value] : start.environment) ::setenv(name.c_str(), value.c_str(), 1);
  preload(start.preloaded);
  if (!start.prepare || start.prepare()) ::execv(words.front(), words.data());
  ::_exit(127);
}

OtherProgram::OtherProgram(const std::function<void()>& body) : id_(copy_of_this_program()) {
  if (id_ != 0) return;
  body();
  ::_exit(0);
}

OtherProgram::~OtherProgram() {
  if (is_running()) {
    kill();
    ::waitpid(id_, nullptr, 0);
  }
  if (output_ >= 0) ::close(output_);
  end_input();
}

void OtherProgram::send(int signal) {
  if (is_running()) ::kill(id_, signal);
}
void OtherProgram::kill() { send(SIGKILL); }
void OtherProgram::stop() { send(SIGSTOP); }
void OtherProgram::resume() { send(SIGCONT); }
void OtherProgram::interrupt() { send(SIGINT); }

void OtherProgram::type(const std::string& text) {
  ::signal(SIGPIPE, SIG_IGN);  // where it has ended meanwhile
  [[maybe_unused]] const ssize_t written = ::write(input_, text.data(), text.size());
}
void OtherProgram::end_input() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
}

bool OtherProgram::echoes() const {
  termios settings{};
  return ::tcgetattr(input_, &settings) == 0 && (settings.c_lflag & ECHO) != 0;
}

bool OtherProgram::is_running() {
  output();  // a terminal that nobody reads stops who writes
  if (!ended_) ended_ = ::waitpid(id_, &status_, WNOHANG) != 0;
  return !ended_;
}

std::optional<int> OtherProgram::wait(Time patience) {
  const Time deadline = MonotonicClock::now() + patience;
  while (is_running() && MonotonicClock::now() < deadline) std::this_thread::sleep_for(1ms);
  if (is_running() || !WIFEXITED(status_)) return std::nullopt;
  return WEXITSTATUS(status_);
}

bool OtherProgram::writes(const std::string& text, Time patience) {
  const Time deadline = MonotonicClock::now() + patience;
  const auto written = [&] { return output().find(text) != std::string::npos; };
  while (!written() && is_running() && MonotonicClock::now() < deadline) std::this_thread::sleep_for(10ms);
  return written();
}

std::string OtherProgram::output() const {
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t size = 0;
       (size = ::pread(output_, part.data(), part.size(), static_cast<off_t>(text.size()))) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  for (ssize_t size = 0; has_terminal_ && (size = ::read(input_, part.data(), part.size())) > 0;)
    screen_.append(part.data(), static_cast<std::size_t>(size));
  return screen_ + text;
}

}  // namespace flinch::test
