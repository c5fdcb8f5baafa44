#include "apps/flinch/program_start.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>

namespace flinch {
namespace {

bool is_open(int descriptor) { return ::fcntl(descriptor, F_GETFD) >= 0; }

/// The lowest number that is free is the stream's, for those below it are open.
void open_streams() noexcept {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (is_open(stream)) continue;
    const int access = stream == STDOUT_FILENO ? O_RDONLY : O_RDWR;            // who asks for results is told
    if (::open("/dev/null", access) < 0) ::open("/", O_RDONLY | O_DIRECTORY);  // NOLINT: to be inherited
  }
}

}  // namespace

void start_program() noexcept {
  open_streams();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace flinch
