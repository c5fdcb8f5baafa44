#include "systems/framework/sample_signal.h"

#include <cerrno>

#include "systems/framework/monotonic_clock.h"

namespace flinch {

SampleSignal::SampleSignal() { sem_init(&notified_, 0, 0); }

SampleSignal::~SampleSignal() { sem_destroy(&notified_); }

void SampleSignal::notify() noexcept { sem_post(&notified_); }

bool SampleSignal::wait_until(Time deadline) noexcept {
  const std::timespec limit = MonotonicClock::to_timespec(deadline);
  int result = 0;
  do {
    result = sem_clockwait(&notified_, CLOCK_MONOTONIC, &limit);
  } while (result != 0 && errno == EINTR);
  return result == 0;
}

}  // namespace flinch
