// How often the stated intervals of calibrated parameters hold the truth. docs/theory.md cites what it
// prints.
#include "tests/identification/coverage.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace flinch {
namespace {

void expect_nineteen_of_twenty(const test::Coverage& got) {
  std::printf("  %d of %d intervals of 95 %% hold the truth: %.1f %%\n", got.covered(), got.intervals(),
              100.0 * got.share());
  EXPECT_GE(got.share(), 0.92);
  EXPECT_LE(got.share(), 0.98);
}

TEST(IntervalsOfTorqueConstants, CoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_torque_constants(200, 1));
}

TEST(IntervalsOfImuPoses, CoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_imu_poses(200, 1));
}

TEST(IntervalsOfDynamics, CoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_dynamics(200, 1));
}

}  // namespace
}  // namespace flinch
