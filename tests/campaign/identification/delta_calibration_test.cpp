// Deltas drawn anew, with a payload that nobody knows of: torque constants from rope pulls, then friction,
// arms, rods and platform from a motion that excites them, then what the observer takes for a contact in a
// motion that neither used. The table is printed. FLINCH_ROBOTS in the environment says how many robots
// instead of two.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/identification/calibrated_robot.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::CalibratedRobot;

TEST(Deltas, FindTheirTorqueConstantsAndFeelNoContactThatIsNone) {
  const CalibratedRobot::Replacements shorter = {{"duration_s: 45", "duration_s: 12"},
                                                 {"duration_s: 43", "duration_s: 11"}};
  const auto robots = test::wanted<std::uint64_t>("FLINCH_ROBOTS", 2);
  std::printf("  robot   constants off by   observer before   after\n");
  for (std::uint64_t seed = 1; seed <= robots; ++seed) {
    CalibratedRobot robot(seed);
    const Verdict before = robot.judged("delta_calibration_motion.yaml", shorter);
    const CalibrationResult constants = robot.torque_constants("delta_calibration_pulls.yaml");
    const JointVector truth = robot.scenario("delta_calibration_motion.yaml").station.drives.torque_constant;
    double off = 0.0;
    for (Eigen::Index i = 0; i < truth.size(); ++i)
      off = std::max(off, std::abs(constants.parameters[static_cast<std::size_t>(i)].value / truth[i] - 1.0));
    robot.dynamics("delta_calibration_excitation.yaml");
    const Verdict after = robot.judged("delta_calibration_motion.yaml", shorter);
    std::printf("  %5d %14.2f %% %12.2f N %8.2f N\n", static_cast<int>(seed), 100.0 * off,
                before.max_observer_error_force, after.max_observer_error_force);
    EXPECT_LE(off, 0.01) << seed;
    EXPECT_LE(after.max_observer_error_force, 0.5 * before.max_observer_error_force) << seed;
    EXPECT_GT(before.max_observer_error_force, 2.0) << "there is nothing to show";
  }
}

}  // namespace
}  // namespace flinch
