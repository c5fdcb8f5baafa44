#include "systems/framework/bounded_queue.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <random>
#include <thread>

#include "tests/support/allocations.h"
#include "tests/support/locks.h"

namespace flinch {
namespace {

/// Large enough that a copy takes many instructions; all elements are equal unless it is torn.
struct Wide {
  std::array<std::int64_t, 64> numbers{};

  static Wide filled(std::int64_t number) {
    Wide wide;
    wide.numbers.fill(number);
    return wide;
  }
  bool operator==(const Wide&) const = default;
};

// ---------------------------------------------------------------- laws

TEST(BoundedQueue, BringsEachValueOnceInOrderFromOneThreadToAnother) {
  constexpr std::int64_t pushed = 200'000;
  BoundedQueue<Wide, 16> queue;
  std::thread writer([&queue] {
    for (std::int64_t k = 1; k <= pushed;) {
      if (queue.push(Wide::filled(k))) {
        ++k;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::int64_t wrong = 0;
  for (std::int64_t k = 1; k <= pushed; ++k) {
    Wide value;
    while (!queue.pop(value)) std::this_thread::yield();
    if (value != Wide::filled(k)) ++wrong;
  }
  writer.join();
  EXPECT_EQ(wrong, 0);
  Wide value;
  EXPECT_FALSE(queue.pop(value));
}

TEST(BoundedQueue, LosesOnlyWhatItRefusedToAWriterThatDoesNotWait) {
  constexpr int offered = 200'000;
  BoundedQueue<int, 8> queue;
  std::deque<int> accepted;  // the writer's, until it ends
  std::atomic<bool> ended = false;
  std::thread writer([&] {
    for (int k = 1; k <= offered; ++k) {
      if (queue.push(k)) accepted.push_back(k);
    }
    ended = true;
  });
  std::deque<int> popped;
  for (bool last = false; !last;) {
    last = ended;
    for (int value = 0; queue.pop(value);) popped.push_back(value);
  }
  writer.join();
  EXPECT_EQ(popped, accepted);
  EXPECT_GE(popped.size(), 8u);
}

TEST(BoundedQueue, ShowsWhatTheWriterDidBefore) {
  // Plain memory, handed over by the queue alone: a thread sanitizer sees whether that is enough.
  BoundedQueue<int, 2> queue;
  int beside = 0;
  std::thread writer([&] {
    beside = 42;
    queue.push(1);
  });
  int value = 0;
  while (!queue.pop(value)) std::this_thread::yield();
  EXPECT_EQ(beside, 42);
  writer.join();
}

TEST(BoundedQueue, DoesWhatAQueueWithALimitDoes) {
  std::mt19937 random(7);
  BoundedQueue<int, 4> queue;
  std::deque<int> truth;
  for (int k = 0; k < 10'000; ++k) {
    if (random() % 2 == 0) {
      const bool fits = truth.size() < 4;
      ASSERT_EQ(queue.push(k), fits);
      if (fits) truth.push_back(k);
    } else {
      int value = -1;
      ASSERT_EQ(queue.pop(value), !truth.empty());
      ASSERT_EQ(value, truth.empty() ? -1 : truth.front());
      if (!truth.empty()) truth.pop_front();
    }
  }
}

// ---------------------------------------------------------------- examples

TEST(BoundedQueue, NeitherAllocatesNorLocks) {
  BoundedQueue<Wide, 4> queue;
  Wide value;
  const test::AllocationCounter counter;
  const std::int64_t locks = test::locks();
  for (int k = 0; k < 100; ++k) {
    queue.push(Wide::filled(k));
    if (k % 3 == 0) queue.pop(value);
  }
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(test::locks(), locks);
}

}  // namespace
}  // namespace flinch
