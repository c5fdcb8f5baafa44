// A library to preload (LD_PRELOAD), which needs no privileges: all clocks of the program run more slowly,
// ten times (FLINCH_TEST_SLOWNESS in the environment says how often instead), and all waiting takes as much
// longer. The program itself is as it is, with its periods and limits; it sees a machine that is as many
// times faster, on which a stall of 20 ms is one of 2 ms. Monotonic clocks are divided by the factor, so
// programs with the same factor still share one clock. Processor time stays what it is.
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <limits>

namespace {

constexpr std::int64_t second = 1'000'000'000;  // [ns]
constexpr std::int64_t year = 365 * 24 * 3600 * second;
constexpr std::int64_t longest = 100 * year;  // beyond, a factor would leave the range of the numbers

template <class Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::int64_t slowness() {
  static const std::int64_t factor = [] {
    const char* const text = std::getenv("FLINCH_TEST_SLOWNESS");
    return std::max(text != nullptr ? std::atoll(text) : 10LL, 1LL);
  }();
  return factor;
}

std::int64_t nanoseconds(const timespec& time) {
  return second * std::min<std::int64_t>(time.tv_sec, longest / second) + time.tv_nsec;
}

timespec time_of(std::int64_t nanoseconds) { return {nanoseconds / second, nanoseconds % second}; }

int real_clock(clockid_t clock, timespec* now) {
  static auto* const call = real(&::clock_gettime, "clock_gettime");
  return call(clock, now);
}

std::int64_t real_now(clockid_t clock) {
  timespec now{};
  real_clock(clock, &now);
  return nanoseconds(now);
}

/// How far the slow wall clock is behind: as far as the slow monotonic one.
std::int64_t behind() {
  const std::int64_t monotonic = real_now(CLOCK_MONOTONIC);
  return monotonic - monotonic / slowness();
}

bool is_wall(clockid_t clock) { return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE; }

bool is_monotonic(clockid_t clock) {
  return clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_COARSE || clock == CLOCK_MONOTONIC_RAW ||
         clock == CLOCK_BOOTTIME;
}

std::int64_t lengthened(std::int64_t duration) {
  return duration < longest / slowness() ? duration * slowness() : longest;
}
timespec lengthened(const timespec& duration) { return time_of(lengthened(nanoseconds(duration))); }

/// When the real clock shows what the slow one shows at `deadline`.
timespec real_deadline(clockid_t clock, const timespec& deadline) {
  if (slowness() == 1) return deadline;
  if (!is_wall(clock)) return lengthened(deadline);
  const std::int64_t left = nanoseconds(deadline) - (real_now(CLOCK_REALTIME) - behind());
  return time_of(real_now(CLOCK_REALTIME) + lengthened(std::max<std::int64_t>(left, 0)));
}

/// The clock of a deadline that is not said which it is of.
clockid_t clock_of(const timespec& deadline) {
  return nanoseconds(deadline) < year ? CLOCK_MONOTONIC : CLOCK_REALTIME;
}

int lengthened_ms(int timeout) {
  const std::int64_t all = timeout * slowness();
  return static_cast<int>(std::min<std::int64_t>(all, std::numeric_limits<int>::max()));
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = real_clock(clock, time);
  if (result != 0 || slowness() == 1) return result;
  if (is_monotonic(clock)) *time = time_of(nanoseconds(*time) / slowness());
  if (is_wall(clock)) *time = time_of(nanoseconds(*time) - behind());
  return result;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec wall{};
  clock_gettime(CLOCK_REALTIME, &wall);
  *time = {wall.tv_sec, wall.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* place) noexcept {
  timespec wall{};
  clock_gettime(CLOCK_REALTIME, &wall);
  if (place != nullptr) *place = wall.tv_sec;
  return wall.tv_sec;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* wanted, timespec* left) {
  static auto* const call = real(&::clock_nanosleep, "clock_nanosleep");
  const bool absolute = (flags & TIMER_ABSTIME) != 0;
  const timespec slow = absolute ? real_deadline(clock, *wanted) : lengthened(*wanted);
  return call(clock, flags, &slow, left);
}

int nanosleep(const timespec* wanted, timespec* left) {
  static auto* const call = real(&::nanosleep, "nanosleep");
  const timespec slow = lengthened(*wanted);
  return call(&slow, left);
}

int usleep(useconds_t microseconds) {
  const timespec wanted = time_of(1000 * static_cast<std::int64_t>(microseconds));
  return ::nanosleep(&wanted, nullptr);
}

unsigned sleep(unsigned seconds) {
  const timespec wanted{static_cast<time_t>(seconds), 0};
  return ::nanosleep(&wanted, nullptr) == 0 ? 0 : 1;
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* deadline) {
  static auto* const call = real(&::pthread_cond_timedwait, "pthread_cond_timedwait");
  const timespec slow = real_deadline(clock_of(*deadline), *deadline);
  return call(condition, mutex, &slow);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* deadline) {
  static auto* const call = real(&::pthread_cond_clockwait, "pthread_cond_clockwait");
  const timespec slow = real_deadline(clock, *deadline);
  return call(condition, mutex, clock, &slow);
}

int sem_timedwait(sem_t* semaphore, const timespec* deadline) {
  static auto* const call = real(&::sem_timedwait, "sem_timedwait");
  const timespec slow = real_deadline(CLOCK_REALTIME, *deadline);
  return call(semaphore, &slow);
}

int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* deadline) {
  static auto* const call = real(&::sem_clockwait, "sem_clockwait");
  const timespec slow = real_deadline(clock, *deadline);
  return call(semaphore, clock, &slow);
}

int poll(pollfd* files, nfds_t count, int timeout) {
  static auto* const call = real(&::poll, "poll");
  return call(files, count, lengthened_ms(timeout));
}

int epoll_wait(int file, epoll_event* events, int most, int timeout) {
  static auto* const call = real(&::epoll_wait, "epoll_wait");
  return call(file, events, most, lengthened_ms(timeout));
}

int select(int count, fd_set* readable, fd_set* writable, fd_set* broken, timeval* timeout) {
  static auto* const call = real(&::select, "select");
  if (timeout == nullptr) return call(count, readable, writable, broken, nullptr);
  const timespec all = lengthened({timeout->tv_sec, 1000 * timeout->tv_usec});
  timeval slow{all.tv_sec, all.tv_nsec / 1000};
  return call(count, readable, writable, broken, &slow);
}

}  // extern "C"
