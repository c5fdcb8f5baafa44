#include "systems/framework/random.h"

#include <gtest/gtest.h>

#include <set>

namespace flinch {
namespace {

TEST(RandomGenerator, GivesThePublishedNumbersOfSplitMix64) {
  // The first outputs for the seed 1234567, as published with the reference implementation.
  RandomGenerator generator(1234567);
  EXPECT_EQ(generator(), 6457827717110365317U);
  EXPECT_EQ(generator(), 3203168211198807973U);
  EXPECT_EQ(generator(), 9817491932198370423U);
}

TEST(RandomGenerator, DrawsNormalNumbersWithTheRightMoments) {
  RandomGenerator generator(1);
  const int count = 1'000'000;
  double sum = 0, squares = 0, fourth = 0;
  for (int i = 0; i < count; ++i) {
    const double x = generator.normal();
    sum += x;
    squares += x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / count, 0.0, 4e-3);      // 4 sigma
  EXPECT_NEAR(squares / count, 1.0, 6e-3);  // 4 sigma
  EXPECT_NEAR(fourth / count, 3.0, 4e-2);   // 4 sigma
}

TEST(DeriveSeed, DiffersForEveryNameAndSeed) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const char* name : {"", "a", "b", "ab", "ba", "imu", "encoders"})
      seeds.insert(derive_seed(seed, name));
  }
  EXPECT_EQ(seeds.size(), 700U);
}

}  // namespace
}  // namespace flinch
