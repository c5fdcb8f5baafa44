#include "systems/framework/monotonic_clock.h"

#include <cerrno>

namespace flinch {

Time MonotonicClock::now() noexcept {
  std::timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

void MonotonicClock::sleep_until(Time time) noexcept {
  const std::timespec wanted = to_timespec(time);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wanted, nullptr) == EINTR) continue;
}

std::timespec MonotonicClock::to_timespec(Time time) noexcept {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

}  // namespace flinch
