#include "systems/safety/ring.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(Ring, HoldsTheLastValuesOfASignal) {
  Ring<int, 3> ring;
  Ring<int, 3>::Past past{};
  for (int k = 0; k < 8; ++k) {
    const Series series(ring, past);
    ring.push(k);
    ASSERT_EQ(series.held(), static_cast<std::size_t>(std::min(k + 1, 3)));
    for (std::size_t age = 0; age < series.held(); ++age)
      EXPECT_EQ(series.back(age), k - static_cast<int>(age)) << "at tick " << k;
    ring.keep_in(past);
  }
}

TEST(Ring, KeepsItsNewestValueThroughTicksWithoutOne) {
  Ring<int, 3> ring;
  Ring<int, 3>::Past past{};
  const Series series(ring, past);
  ring.keep_in(past);
  EXPECT_EQ(series.held(), 0U);
  ring.push(1);
  for (int tick = 0; tick < 5; ++tick) ring.keep_in(past);
  EXPECT_EQ(series.held(), 1U);
  EXPECT_EQ(series.back(0), 1);
  ring.push(2);
  EXPECT_EQ(series.back(1), 1);
}

TEST(Ring, BeginsAnewAfterItWasCleared) {
  Ring<int, 3> ring;
  Ring<int, 3>::Past past{};
  const Series series(ring, past);
  for (const int value : {1, 2, 3, 4}) {
    ring.push(value);
    ring.keep_in(past);
  }
  ring.clear();
  EXPECT_EQ(series.held(), 0U);
  ring.push(5);
  EXPECT_EQ(series.held(), 1U);
  ring.keep_in(past);
  ring.push(6);
  EXPECT_EQ(series.held(), 2U);
  EXPECT_EQ(series.back(1), 5);
}

/// What is computed twice in a tick is taken in once.
TEST(Ring, TakesInWhatATickHasSettledOn) {
  Ring<int, 3> last;
  Ring<int, 3>::Past past{};
  last.push(1);
  last.keep_in(past);
  Ring<int, 3> now = last;
  now.push(2);
  now = last;  // evaluated again
  now.push(3);
  EXPECT_EQ(Series(now, past).back(0), 3);
  now.keep_in(past);
  now.push(4);
  EXPECT_EQ(Series(now, past).back(1), 3);
  EXPECT_EQ(Series(now, past).back(2), 1);
}

}  // namespace
}  // namespace flinch
