// Logs that are right, of robots that differ from their model: none may be doubted. FLINCH_ROBOTS says of how
// many.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/dynamics_calibration.h"
#include "identification/imu_pose_calibration.h"
#include "identification/torque_constant_calibration.h"
#include "tests/identification/recorded.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::Simulated;
using ::testing::IsEmpty;

/// What every simulated robot of a scenario is doubted for, drawn by seeds of its own.
template <class Calibrate>
void expect_no_doubt(const char* scenario, Calibrate calibrate) {
  const auto robots = test::wanted<std::uint64_t>("FLINCH_ROBOTS", 2);
  for (std::uint64_t seed = 101; seed < 101 + robots; ++seed) {
    const Simulated run = test::simulated(scenario, {}, seed);
    EXPECT_THAT(calibrate(run).warnings, IsEmpty()) << "seed " << seed;
  }
}

TEST(RightLogs, OfTheImuAreNotDoubted) {
  expect_no_doubt("calibration_rectangle.yaml", [](const Simulated& run) {
    return calibrate_imu_pose(*run.scenario.robot.robot, run.scenario.control.imu_mount,
                              {{{"run.h5", ""}, &run.recording}});
  });
}

TEST(RightLogs, OfPullsAreNotDoubted) {
  expect_no_doubt("calibration_pulls.yaml", [](const Simulated& run) {
    const TorqueConstantBelief belief{.robot = run.scenario.robot.robot.get(),
                                      .drives = run.scenario.robot.drives,
                                      .constant = run.scenario.control.drive_torque.torque_constant};
    return calibrate_torque_constants(belief, {{{"run.h5", ""}, &run.recording, run.scenario.mountings}}, {});
  });
}

TEST(RightLogs, OfMotionAreNotDoubted) {
  expect_no_doubt("calibration_excitation.yaml", [](const Simulated& run) {
    const DynamicsBelief belief{.robot = run.scenario.robot.robot.get(),
                                .drives = run.scenario.robot.drives,
                                .constant = run.scenario.control.drive_torque.torque_constant};
    return calibrate_dynamics(belief, {{{"run.h5", ""}, &run.recording}}, {});
  });
}

}  // namespace
}  // namespace flinch
