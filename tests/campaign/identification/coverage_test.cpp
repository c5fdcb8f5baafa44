// How often the stated intervals of calibrated parameters hold the truth: FLINCH_CALIBRATIONS=200 in the
// environment counts it, and docs/theory.md cites what is printed. tests/identification counts in a few.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/identification/coverage.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

class Intervals : public ::testing::Test {
 protected:
  void SetUp() override {
    calibrations_ = test::wanted("FLINCH_CALIBRATIONS", 0);
    if (calibrations_ == 0) GTEST_SKIP() << "FLINCH_CALIBRATIONS=200 says how many to count in";
  }
  static void expect_nineteen_of_twenty(const test::Coverage& got) {
    std::printf("  %d of %d intervals of 95 %% hold the truth: %.1f %%\n", got.covered(), got.intervals(),
                100.0 * got.share());
    EXPECT_GE(got.share(), 0.92);
    EXPECT_LE(got.share(), 0.98);
  }
  int calibrations_ = 0;
};

TEST_F(Intervals, OfTorqueConstantsCoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_torque_constants(calibrations_, 1));
}

TEST_F(Intervals, OfImuPosesCoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_imu_poses(calibrations_, 1));
}

TEST_F(Intervals, OfDynamicsCoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_dynamics(calibrations_, 1));
}

}  // namespace
}  // namespace flinch
