#include "tests/fault/link/started_program.h"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "systems/framework/monotonic_clock.h"

namespace flinch::test {

bool enter_network(const std::string& network) {
  if (network.empty()) return true;
  const int space = ::open(("/run/netns/" + network).c_str(), O_RDONLY | O_CLOEXEC);
  const bool entered = ::setns(space, CLONE_NEWNET) == 0;
  ::close(space);
  return entered;
}

StartedProgram::StartedProgram(const std::vector<std::string>& arguments,
                               const std::map<std::string, std::string>& environment,
                               const std::string& network)
    : output_(::memfd_create("output", MFD_CLOEXEC)) {
  std::vector<char*> words = {const_cast<char*>(FLINCH_PROGRAM)};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  id_ = ::fork();
  if (id_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(output_, STDOUT_FILENO);
  ::dup2(output_, STDERR_FILENO);
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  if (enter_network(network)) ::execv(words.front(), words.data());
  ::_exit(127);
}

StartedProgram::~StartedProgram() {
  if (!has_ended()) {
    kill();
    ::waitpid(id_, nullptr, 0);
  }
  ::close(output_);
}

void StartedProgram::send(int signal) {
  if (!has_ended()) ::kill(id_, signal);
}
void StartedProgram::kill() { send(SIGKILL); }
void StartedProgram::stop() { send(SIGSTOP); }
void StartedProgram::resume() { send(SIGCONT); }
void StartedProgram::interrupt() { send(SIGINT); }

bool StartedProgram::has_ended() {
  if (!ended_) ended_ = ::waitpid(id_, &status_, WNOHANG) != 0;
  return ended_;
}
bool StartedProgram::is_running() { return !has_ended(); }

std::optional<int> StartedProgram::wait(Time patience) {
  const Time deadline = MonotonicClock::now() + patience;
  while (!has_ended() && MonotonicClock::now() < deadline) ::usleep(2000);
  if (!has_ended() || !WIFEXITED(status_)) return std::nullopt;
  return WEXITSTATUS(status_);
}

std::string StartedProgram::output() const {
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t size = 0;
       (size = ::pread(output_, part.data(), part.size(), static_cast<off_t>(text.size()))) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  return text;
}

}  // namespace flinch::test
