#include "systems/foundation/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// Its command line, as /proc shows it.
std::string command_of(const std::string& process) {
  std::ifstream file("/proc/" + process + "/cmdline", std::ios::binary);
  std::string command{std::istreambuf_iterator<char>(file), {}};
  while (!command.empty() && command.back() == '\0') command.pop_back();
  for (char& letter : command) letter = letter == '\0' ? ' ' : letter;
  return command;
}

/// "the process 1234 (flinch run ...)": who has the lock, by /proc/locks.
std::string holder_of(int folder) {
  struct stat status {};
  if (::fstat(folder, &status) != 0) return "another program";
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, advisory, access, process, place;
    words >> number >> kind >> advisory >> access >> process >> place;
    if (kind != "FLOCK" || !place.ends_with(":" + std::to_string(status.st_ino))) continue;
    const std::string command = command_of(process);
    return "the process " + process + (command.empty() ? "" : " (" + command + ")");
  }
  return "another program";
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  const std::string holder = holder_of(descriptor_);
  ::close(descriptor_);
  throw SetupError(folder.string() + ": " + holder +
                   " writes its results there; wait for its end, or choose another folder");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace flinch
