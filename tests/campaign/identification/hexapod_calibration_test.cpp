// Hexapods drawn anew, with a payload of 2 kg and more that nobody knows of: force constants from rope pulls,
// then friction and platform from a motion that excites them, then what the observer takes for a contact in a
// motion that neither used. The table is printed. FLINCH_ROBOTS in the environment says how many robots
// instead of one, which is judged by half of that motion; each takes two minutes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/identification/calibrated_robot.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::CalibratedRobot;

std::uint64_t robots() { return test::wanted<std::uint64_t>("FLINCH_ROBOTS", 1); }

/// The motion on which they are judged is shorter than the one for thresholds, and has one estimator.
CalibratedRobot::Replacements shorter() {
  const std::string seconds = robots() > 1 ? "14" : "6", whole = robots() > 1 ? "16" : "8";
  return {{"duration_s: 47", "duration_s: " + whole},
          {"duration_s: 45", "duration_s: " + seconds},
          {"  estimators: [momentum_observer, disturbance_filter, imu_residual]\n", ""},
          {"  detectors: [contact_detector, fused_detector]", "  #"}};
}

/// Largest share by which a force constant is off.
double error_of(const CalibrationResult& found, const JointVector& truth) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const CalibratedParameter& constant = found.parameters[static_cast<std::size_t>(i)];
    EXPECT_TRUE(constant.identifiable) << constant.name;
    largest = std::max(largest, std::abs(constant.value / truth[i] - 1.0));
  }
  return largest;
}

TEST(Hexapods, FindTheirForceConstantsAndFeelNoContactThatIsNone) {
  std::printf("  robot   constants off by   observer before         after\n");
  for (std::uint64_t seed = 1; seed <= robots(); ++seed) {
    CalibratedRobot robot(seed);
    const Verdict before = robot.judged("hexapod_calibration_motion.yaml", shorter());
    const CalibrationResult constants = robot.torque_constants("hexapod_calibration_pulls.yaml");
    const JointVector truth =
        robot.scenario("hexapod_calibration_motion.yaml").station.drives.torque_constant;
    const double off = error_of(constants, truth);
    robot.dynamics("hexapod_calibration_excitation.yaml");
    const Verdict after = robot.judged("hexapod_calibration_motion.yaml", shorter());
    std::printf("  %5d %14.2f %% %8.1f N %6.2f Nm %7.1f N %5.2f Nm\n", static_cast<int>(seed), 100.0 * off,
                before.max_observer_error_force, before.max_observer_error_moment,
                after.max_observer_error_force, after.max_observer_error_moment);
    EXPECT_LE(off, 0.01) << seed;
    EXPECT_LE(after.max_observer_error_force, 12.0) << seed;
    EXPECT_LE(after.max_observer_error_moment, 2.5) << seed;
    EXPECT_GT(before.max_observer_error_force, 40.0) << "there is nothing to show";
  }
}

}  // namespace
}  // namespace flinch
