#include "tests/identification/coverage.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

// So few intervals would cover the truth by chance once in ten thousand times if the stated deviations were
// right.
constexpr double by_chance = 1e-4;

TEST(IntervalsOfTorqueConstants, CoverTheTruthAsOftenAsStated) {
  EXPECT_GT(test::cover_torque_constants(20, 1000).probability(), by_chance);
}

TEST(IntervalsOfImuPoses, CoverTheTruthAsOftenAsStated) {
  EXPECT_GT(test::cover_imu_poses(8, 1000).probability(), by_chance);
}

TEST(IntervalsOfDynamics, CoverTheTruthAsOftenAsStated) {
  EXPECT_GT(test::cover_dynamics(8, 1000, test::RobotsDrawn::as_believed).probability(), by_chance);
}

}  // namespace
}  // namespace flinch
