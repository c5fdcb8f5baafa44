// How often the stated intervals of calibrated torque constants hold the truth. docs/theory.md cites what it
// prints.
#include "tests/identification/coverage.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace flinch {
namespace {

TEST(IntervalsOfTorqueConstants, CoverTheTruthInNineteenOfTwentyCalibrations) {
  const test::Coverage got = test::cover(200, 1);
  std::printf("  %d of %d intervals of 95 %% hold the truth: %.1f %%\n", got.covered, got.intervals,
              100.0 * got.share());
  EXPECT_GE(got.share(), 0.92);
  EXPECT_LE(got.share(), 0.98);
}

}  // namespace
}  // namespace flinch
