#include "apps/flinch/own_command.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "systems/foundation/bytes_of_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// The last line that says something.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n ");
  if (end == std::string::npos) return "nothing";
  const std::size_t begin = text.find_last_of("\r\n", end) + 1;  // 0 where there is none
  return text.substr(begin, end + 1 - begin);
}

/// The wait status of this program with these words; its stdout and stderr go to files of `folder`.
int status_of(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "command.out", O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "command.log", O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  std::string name = "flinch";
  std::vector<std::string> copies = words;
  std::vector<char*> arguments{name.data()};
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t id = 0;
  const int error = ::posix_spawn(&id, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw SetupError("cannot start 'flinch " + words.front() + "': " + std::system_category().message(error));
  int status = 0;
  while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

std::string run_own_command(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const int status = status_of(words, folder);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::string command = "flinch";
    for (const std::string& word : words) command += " " + word;
    throw SetupError("'" + command + "' failed: " + last_line(bytes_of_file(folder / "command.log")));
  }
  std::string printed = bytes_of_file(folder / "command.out");
  std::filesystem::remove(folder / "command.out");
  std::filesystem::remove(folder / "command.log");
  return printed;
}

}  // namespace flinch
