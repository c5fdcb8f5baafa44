#include "tests/peer/fast_dds/fast_dds_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

namespace flinch::test {

FastDdsProgram::FastDdsProgram(std::uint32_t domain, const char* reliability) {
  const std::string number = std::to_string(domain);
  int in[2], out[2];
  if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  id_ = ::fork();
  if (id_ == 0) {
    ::dup2(in[0], STDIN_FILENO);
    ::dup2(out[1], STDOUT_FILENO);
    ::execl(FLINCH_FAST_DDS_SUBSCRIBER, "fast_dds_subscriber", number.c_str(), reliability, nullptr);
    ::_exit(127);
  }
  ::close(in[0]);
  ::close(out[1]);
  input_ = in[1];
  output_ = out[0];
  reader_ = std::thread(&FastDdsProgram::read_lines, this);
}

FastDdsProgram::~FastDdsProgram() {
  ::close(input_);
  reader_.join();
  ::waitpid(id_, nullptr, 0);
}

void FastDdsProgram::read_lines() {
  std::FILE* lines = ::fdopen(output_, "r");
  std::string line;
  for (int letter = std::getc(lines); letter != EOF; letter = std::getc(lines)) {
    if (letter != '\n') {
      line += static_cast<char>(letter);
      continue;
    }
    const std::size_t space = line.find(' ');
    const std::lock_guard lock(mutex_);
    messages_[line.substr(0, space)].push_back(line.substr(space));
    line.clear();
  }
  std::fclose(lines);
}

std::vector<std::string> FastDdsProgram::messages(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  const auto found = messages_.find(topic);
  return found == messages_.end() ? std::vector<std::string>() : found->second;
}

}  // namespace flinch::test
