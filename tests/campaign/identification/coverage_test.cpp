// How often the stated intervals of calibrated parameters hold the truth, and how errors compare with stated
// deviations. docs/theory.md cites what FLINCH_CALIBRATIONS=200 in the environment makes it print.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/identification/coverage.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr std::uint64_t first_seed = 30001;
constexpr double by_chance = 1e-4;
constexpr int enough_for_shares = 200;

class Intervals : public ::testing::Test {
 protected:
  static void tell(const test::Coverage& got) {
    got.print();
    std::printf("  %d of %d intervals of 95 %% hold the truth: %.1f %%; errors are %.2f stated deviations\n",
                got.covered(), got.intervals(), 100.0 * got.share(), got.scatter());
  }
  /// No parameter misses the truth more often than it would by chance once in ten thousand times; in as many
  /// calibrations as tell shares to a percent, the share of all intervals is what was asked.
  void expect_nineteen_of_twenty(const test::Coverage& got) const {
    tell(got);
    EXPECT_GT(got.probability(), by_chance);
    if (calibrations_ < enough_for_shares) return;
    EXPECT_GE(got.share(), 0.92);
    EXPECT_LE(got.share(), 0.98);
  }
  int calibrations_ = test::wanted("FLINCH_CALIBRATIONS", 12);
};

TEST_F(Intervals, OfTorqueConstantsCoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_torque_constants(calibrations_, first_seed));
}

TEST_F(Intervals, OfImuPosesCoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_imu_poses(calibrations_, first_seed));
}

TEST_F(Intervals, OfDynamicsCoverTheTruthInNineteenOfTwentyCalibrations) {
  expect_nineteen_of_twenty(test::cover_dynamics(calibrations_, first_seed, test::RobotsDrawn::as_believed));
}

TEST_F(Intervals, OfDynamicsAreTooWideForRobotsThatAreNearerToTheirModelThanIsBelieved) {
  const auto near = test::RobotsDrawn::near_their_model;
  const test::Coverage got = test::cover_dynamics(calibrations_, first_seed, near);
  tell(got);
  EXPECT_GE(got.share(), 0.92);
}

}  // namespace
}  // namespace flinch
