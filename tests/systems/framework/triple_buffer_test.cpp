#include "systems/framework/triple_buffer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

#include "tests/support/allocations.h"

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
  bool torn() const { return *this != filled(numbers[0]); }
  bool operator==(const Wide&) const = default;
};

// ---------------------------------------------------------------- laws

TEST(TripleBuffer, NeverTearsNeverGoesBackAndEndsWithTheNewest) {
  constexpr std::int64_t published = 200'000;
  TripleBuffer<Wide> buffer;
  std::thread writer([&buffer] {
    for (std::int64_t k = 1; k <= published; ++k) buffer.publish(Wide::filled(k));
  });
  Wide value;
  std::int64_t torn = 0, went_back = 0;
  while (value.numbers[0] != published) {
    const std::int64_t before = value.numbers[0];
    if (!buffer.take(value)) continue;
    if (value.torn()) ++torn;
    if (value.numbers[0] <= before) ++went_back;
  }
  writer.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(went_back, 0);
  EXPECT_FALSE(buffer.take(value));
}

TEST(TripleBuffer, ShowsWhatTheWriterDidBefore) {
  // Plain memory, handed over by the buffer alone: a thread sanitizer sees whether that is enough.
  TripleBuffer<int> buffer;
  int beside = 0;
  std::thread writer([&] {
    beside = 42;
    buffer.publish(1);
  });
  int value = 0;
  while (!buffer.take(value)) std::this_thread::yield();
  EXPECT_EQ(beside, 42);
  writer.join();
}

// ---------------------------------------------------------------- examples

TEST(TripleBuffer, TakesEachValueOnceAndOnlyTheLatest) {
  TripleBuffer<int> buffer;
  int value = -1;
  EXPECT_FALSE(buffer.take(value));
  EXPECT_EQ(value, -1);

  buffer.publish(1);
  EXPECT_TRUE(buffer.take(value));
  EXPECT_EQ(value, 1);
  EXPECT_FALSE(buffer.take(value));

  for (int k = 2; k <= 5; ++k) buffer.publish(k);
  EXPECT_TRUE(buffer.take(value));
  EXPECT_EQ(value, 5);
  EXPECT_FALSE(buffer.take(value));
  EXPECT_EQ(value, 5);
}

TEST(TripleBuffer, NeverAllocates) {
  TripleBuffer<Wide> buffer;
  Wide value;
  const test::AllocationCounter counter;
  for (int k = 0; k < 100; ++k) {
    buffer.publish(Wide::filled(k));
    buffer.take(value);
  }
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
