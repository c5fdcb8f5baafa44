#pragma once

#include <chrono>
#include <ctime>

namespace flinch::test {

/// Processor time that this thread has used: what to compare on a machine that does other things as well.
inline std::chrono::duration<double> processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace flinch::test
