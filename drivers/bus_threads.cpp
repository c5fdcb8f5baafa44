#include "drivers/bus_threads.h"

#include <sched.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "systems/foundation/setup_error.h"

namespace flinch {

std::set<pid_t> threads_of_program() {
  std::set<pid_t> threads;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    threads.insert(static_cast<pid_t>(std::stol(entry.path().filename().string())));
  }
  return threads;
}

void make_urgent_since(const std::set<pid_t>& before, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  for (const pid_t thread : threads_of_program()) {
    if (before.contains(thread) || sched_setscheduler(thread, SCHED_FIFO, &parameters) == 0) continue;
    if (errno == ESRCH) continue;  // it has ended meanwhile
    throw SetupError("the threads of the bus cannot have the real-time priority " + std::to_string(priority) +
                     ": " + std::strerror(errno));
  }
}

}  // namespace flinch
