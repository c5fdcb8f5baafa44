#include "tests/support/machine_monitor.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <iostream>
#include <list>
#include <memory>
#include <sstream>

#include "systems/framework/monotonic_clock.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"

namespace flinch::test {
namespace {

/// Waits for every millisecond on one processor, and keeps how late it was at most.
[[noreturn]] void keep_lateness(int processor, std::atomic<Time>& longest) {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(processor), &one);
  ::sched_setaffinity(0, sizeof one, &one);
  for (Time due = MonotonicClock::now();; due = MonotonicClock::now() + 1ms) {
    MonotonicClock::sleep_until(due);
    longest = std::max(longest.load(), MonotonicClock::now() - due);
  }
}

class Watch {
 public:
  Watch() {
    cpu_set_t ours;
    ::sched_getaffinity(0, sizeof ours, &ours);
    for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
      if (CPU_ISSET(static_cast<std::size_t>(processor), &ours)) watchers_.emplace_back(processor);
    }
  }
  Time longest() const {
    Time longest{};
    for (const Watcher& watcher : watchers_) longest = std::max(longest, watcher.longest->load());
    return longest;
  }

 private:
  struct Watcher {
    explicit Watcher(int processor) : program([this, processor] { keep_lateness(processor, *longest); }) {}
    SharedMemory<std::atomic<Time>> longest;
    OtherProgram program;
  };
  std::list<Watcher> watchers_;
};

std::unique_ptr<Watch> watch;

/// Watches while a test runs.
class WatchEachTest final : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { watch = std::make_unique<Watch>(); }
  void OnTestEnd(const testing::TestInfo& test) override {
    if (test.result()->Failed() && machine_stall() >= noticeable_stall) {
      std::cout << not_measured() << std::endl;
    }
    watch.reset();
  }
};

const bool is_watching = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new WatchEachTest);
  return true;
}();

}  // namespace

Time machine_stall() { return watch ? watch->longest() : Time::zero(); }

std::string not_measured() {
  std::ostringstream text;
  text << "not measured: the machine stalled for " << 1e3 * to_seconds(machine_stall()) << " ms";
  return text.str();
}

}  // namespace flinch::test
