// A library to preload (LD_PRELOAD), which needs no privileges: the network and the wall clock of the program
// misbehave as a file says that the environment names (trouble.h). It stands between the program and the C
// library:
//   recvmsg        spoils the first bytes of some datagrams, by which the bus knows its own: they are lost
//   sendmsg        sends some datagrams twice, some 1.5 ms late (later ones overtake), holds all back for a
//   while clock_gettime  tells a CLOCK_REALTIME that has been stepped; so do gettimeofday and time
// What goes out late is sent by a thread of this library. Chance comes from a generator with a fixed seed.
#include "tests/support/trouble.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <mutex>
#include <random>
#include <vector>

namespace {

using flinch::test::Trouble;

constexpr std::int64_t overtaken_by = 1'500'000;    // [ns]
constexpr std::int64_t bursts_apart = 10'000'000;   // [ns]
constexpr std::int64_t longest_slice = 20'000'000;  // [ns]
constexpr std::int64_t year = 365ll * 24 * 3600 * 1'000'000'000;

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

int real_clock(clockid_t clock, timespec* now) {
  static const auto call = real<int (*)(clockid_t, timespec*)>("clock_gettime");
  return call(clock, now);
}

ssize_t real_send(int socket, const msghdr* message, int flags) {
  static const auto call = real<ssize_t (*)(int, const msghdr*, int)>("sendmsg");
  return call(socket, message, flags);
}

std::int64_t nanoseconds(const timespec& time) {
  return 1'000'000'000 * static_cast<std::int64_t>(time.tv_sec) + time.tv_nsec;
}

timespec time_of(std::int64_t nanoseconds) {
  return {nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000};
}

std::int64_t now() {
  timespec time{};
  real_clock(CLOCK_MONOTONIC, &time);
  return nanoseconds(time);
}

Trouble& trouble() {
  static Trouble none{};
  static Trouble* const mapped = [] {
    const char* const file = std::getenv(Trouble::variable);
    if (file == nullptr) return &none;
    const int descriptor = ::open(file, O_RDWR | O_CLOEXEC);
    void* const memory = ::mmap(nullptr, sizeof(Trouble), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    ::close(descriptor);
    return memory == MAP_FAILED ? &none : static_cast<Trouble*>(memory);
  }();
  return *mapped;
}

/// True as often as said. From any thread.
bool chance(std::uint32_t per_mille) {
  if (per_mille == 0) return false;
  static std::mutex mutex;
  static std::minstd_rand generator(1);
  const std::lock_guard lock(mutex);
  return generator() % 1000 < per_mille;
}

/// Datagrams that wait, and the thread that sends them when they are due.
class LatePost {
 public:
  /// `held`: others may not overtake it.
  void post(int socket, const msghdr& message, std::int64_t due, bool held) {
    Datagram datagram{due, held, socket, {}, {}};
    const auto* const address = static_cast<const char*>(message.msg_name);
    datagram.address.assign(address, address + message.msg_namelen);
    for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
      const auto* const part = static_cast<const char*>(message.msg_iov[i].iov_base);
      datagram.bytes.insert(datagram.bytes.end(), part, part + message.msg_iov[i].iov_len);
    }
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(datagram));
    if (held) ++held_;
    if (!started_) ::pthread_create(&thread_, nullptr, &LatePost::run, this);
    started_ = true;
  }

  /// Whether something is being held back.
  bool holds() const { return held_ > 0; }

 private:
  struct Datagram {
    std::int64_t due;
    bool held;
    int socket;
    std::vector<char> address;
    std::vector<char> bytes;
  };

  static void* run(void* self) {
    for (;;) static_cast<LatePost*>(self)->send_due(), ::usleep(100);
  }

  void send_due() {
    const std::lock_guard lock(mutex_);
    while (!waiting_.empty() && waiting_.front().due <= now()) {
      Datagram& next = waiting_.front();
      iovec part{next.bytes.data(), next.bytes.size()};
      msghdr message{};
      message.msg_name = next.address.data();
      message.msg_namelen = static_cast<socklen_t>(next.address.size());
      message.msg_iov = &part;
      message.msg_iovlen = 1;
      real_send(next.socket, &message, 0);
      if (next.held) --held_;
      waiting_.pop_front();
    }
  }

  std::mutex mutex_;
  std::deque<Datagram> waiting_;
  std::atomic<int> held_ = 0;
  bool started_ = false;
  pthread_t thread_{};
};

LatePost& late_post() {
  static auto* const post = new LatePost();  // its thread outlives main()
  return *post;
}

/// How a datagram goes out that is handed over now.
struct Dispatch {
  bool at_once = true;
  std::int64_t due = 0;
  bool held = false;
};

Dispatch dispatch(Trouble& present) {
  const std::int64_t time = now();
  if (time >= present.held_from && time < present.held_until) {
    ++present.held;
    return {.at_once = false, .due = present.held_until, .held = true};
  }
  if (late_post().holds()) return {.at_once = false, .due = time, .held = true};
  static std::atomic<std::int64_t> last_burst = 0;
  if (time - last_burst < bursts_apart || !chance(present.overtaken_per_mille)) return {};
  last_burst = time;
  ++present.overtaken;
  return {.at_once = false, .due = time + overtaken_by};
}

std::size_t size_of(const msghdr& message) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) size += message.msg_iov[i].iov_len;
  return size;
}

void step(timespec& wall) {
  Trouble& present = trouble();
  const std::int64_t by = present.wall_clock_step;
  if (by == 0) return;
  ++present.wrong_wall_times;
  wall = time_of(nanoseconds(wall) + by);
}

}  // namespace

extern "C" {

ssize_t recvmsg(int socket, msghdr* message, int flags) {
  static const auto call = real<ssize_t (*)(int, msghdr*, int)>("recvmsg");
  const ssize_t size = call(socket, message, flags);
  Trouble& present = trouble();
  if (size >= 4 && message->msg_iovlen > 0 && chance(present.lost_per_mille)) {
    std::memcpy(message->msg_iov[0].iov_base, "LOST", 4);
    ++present.lost;
  }
  return size;
}

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  if (message->msg_name == nullptr) return real_send(socket, message, flags);
  Trouble& present = trouble();
  if (const Dispatch how = dispatch(present); !how.at_once) {
    late_post().post(socket, *message, how.due, how.held);
    return static_cast<ssize_t>(size_of(*message));
  }
  if (chance(present.duplicated_per_mille)) {
    ++present.duplicated;
    real_send(socket, message, flags);
  }
  return real_send(socket, message, flags);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = real_clock(clock, time);
  if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) step(*time);
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

/// In slices, since the clock may be stepped meanwhile.
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* deadline) {
  static const auto call =
      real<int (*)(pthread_cond_t*, pthread_mutex_t*, const timespec*)>("pthread_cond_timedwait");
  if (nanoseconds(*deadline) < year) return call(condition, mutex, deadline);  // by another clock
  for (;;) {
    timespec wall{};
    real_clock(CLOCK_REALTIME, &wall);
    const std::int64_t left = nanoseconds(*deadline) - nanoseconds(wall) - trouble().wall_clock_step;
    if (left <= 0) return ETIMEDOUT;
    const timespec slice = time_of(nanoseconds(wall) + std::min(left, longest_slice));
    const int result = call(condition, mutex, &slice);
    if (result != ETIMEDOUT) return result;
  }
}

}  // extern "C"
