#include "systems/robot/kinematic_causes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

/// A circle about home, in the angles of the drives.
std::vector<JointVector> circle(const ParallelRobot& robot) {
  std::vector<JointVector> rows;
  for (int k = 0; k < 100; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 100.0;
    Configuration pose = robot.home_pose();
    pose[0] += 0.1 * std::cos(angle);
    pose[1] += 0.1 * std::sin(angle);
    rows.push_back(robot.inverse_kinematics(pose, robot.home_working_mode()).joints.active);
  }
  return rows;
}

class KinematicCauses : public testing::Test {
 protected:
  template <class Change>
  std::vector<std::string> causes(Change change) const {
    std::vector<JointVector> rows = circle(robot);
    for (JointVector& row : rows) change(row);
    return likely_kinematic_causes(robot, rows);
  }
  PlanarRrr robot{rig_robot(RigGeometry::individual, RigFriction::none)};
};

TEST_F(KinematicCauses, AreNoneWhereTheRobotCanStandSo) {
  EXPECT_THAT(causes([](JointVector&) {}), IsEmpty());
}

TEST_F(KinematicCauses, NameAnotherUnit) {
  EXPECT_THAT(causes([](JointVector& q) { q *= 180.0 / std::numbers::pi; }),
              Contains("the angles are in deg and were taken for rad"));
}

TEST_F(KinematicCauses, AreNoneWhereNothingHelps) {
  EXPECT_THAT(causes([](JointVector& q) { q = JointVector::Constant(3, 1.7); }), IsEmpty());
}

}  // namespace
}  // namespace flinch
