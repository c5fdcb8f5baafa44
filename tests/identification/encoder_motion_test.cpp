#include "identification/encoder_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "identification/dynamics_calibration.h"
#include "systems/signals/joint_reading.h"
#include "tests/identification/recorded.h"

namespace flinch {
namespace {

/// A five-bar without passive encoders in motion without contact.
test::Simulated free_five_bar() {
  test::Simulated run = test::simulated(
      "five_bar_collision.yaml",
      {{"kind: passage", "kind: random"},
       {"pose: {x_mm: 0, y_mm: 330}\n  direction_deg: 90\n  speed_m_per_s: 0.5\n  cruise_mm: 20\n"
        "  acceleration_m_per_s2: 12\n  jerk_m_per_s3: 600",
        "duration_s: 8\n  distance_mm: 60\n"
        "  limits: {velocity_m_per_s: 0.6, acceleration_m_per_s2: 10, jerk_m_per_s3: 600}"},
       {"duration_s: 1.2", "duration_s: 9"},
       {"pylon: {x_mm: 0, y_mm: 385, radius_mm: 20, stiffness_N_per_m: 6000}", ""},
       {"contact: platform", "contact: none"}});
  test::edit<JointReading>(run.recording, "joints",
                           [](std::size_t, JointReading& reading) { reading.passive_valid = false; });
  return run;
}

WorkingMode turned(WorkingMode mode, int leg) {
  mode[leg] = 1 - mode[leg];
  return mode;
}

TEST(ValidStretches, AreDividedWhereALegChangesTheSideOfItsElbow) {
  test::Simulated run = test::simulated("five_bar_collision.yaml");
  const ParallelRobot& robot = *run.scenario.robot.robot;
  const WorkingMode before = turned(robot.home_working_mode(), 1), after = turned(before, 0);
  const auto pose_at = [&robot](std::size_t k) {
    PlatformVector step = PlatformVector::Zero(2);
    step[0] = 0.02 * std::sin(0.005 * static_cast<double>(k));
    return robot.space().plus(robot.home_pose(), step);
  };
  constexpr std::size_t fold = 500;
  test::edit<JointReading>(run.recording, "joints", [&](std::size_t k, JointReading& reading) {
    reading.active = robot.inverse_kinematics(pose_at(k), k < fold ? before : after).joints.active;
    reading.passive_valid = false;
  });
  for (Signal& signal : run.recording.signals) {
    if (signal.path == "reaction") signal.path = "not looked at";
  }
  const std::vector<ValidStretch> stretches = valid_stretches(run.recording, robot, 100);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].robot(robot).home_working_mode(), before);
  EXPECT_EQ(stretches[1].robot(robot).home_working_mode(), after);
  EXPECT_EQ(stretches[1].first, fold);
  EXPECT_EQ(stretches[1].first + stretches[1].count, run.recording.samples());
  for (const ValidStretch& stretch : stretches) {
    const EncoderMotion motion = encoder_motion(run.recording, robot, stretch, 100.0);
    for (std::size_t k = 50; k + 50 < stretch.count; ++k)
      EXPECT_LT(robot.difference(motion.pose[k], pose_at(stretch.first + k)).norm(), 1e-6) << k;
  }
}

TEST(ValidStretches, OfALogWithoutPassiveAnglesAreCalibratedWhicheverSideAnElbowIsOnAtHome) {
  const test::Simulated run = free_five_bar();
  DynamicsBelief belief{.robot = run.scenario.robot.robot.get(),
                        .drives = run.scenario.robot.drives,
                        .constant = run.scenario.control.drive_torque.torque_constant};
  const CalibrationResult right = calibrate_dynamics(belief, {{{"run.h5", ""}, &run.recording}}, {});
  const auto other = belief.robot->assembled_as(turned(belief.robot->home_working_mode(), 0));
  ASSERT_NE(other, nullptr);
  belief.robot = other.get();
  const CalibrationResult folded = calibrate_dynamics(belief, {{{"run.h5", ""}, &run.recording}}, {});
  ASSERT_EQ(folded.parameters.size(), right.parameters.size());
  int identified = 0;
  for (std::size_t i = 0; i < right.parameters.size(); ++i) {
    const CalibratedParameter& one = right.parameters[i];
    EXPECT_EQ(folded.parameters[i].identifiable, one.identifiable) << one.name;
    if (!one.identifiable || !one.deviation) continue;
    EXPECT_NEAR(folded.parameters[i].value, one.value, 0.01 * *one.deviation) << one.name;
    ++identified;
  }
  EXPECT_GT(identified, 5);
}

}  // namespace
}  // namespace flinch
