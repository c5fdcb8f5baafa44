#include "systems/robot/planar_determinants.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/systems/robot/mechanism_cases.h"

namespace flinch {
namespace {

constexpr double step = 1e-5;  // [m or rad]

Kinematics at(const PlanarRrr& robot, const PlatformVector& pose) {
  Kinematics kinematics;
  robot.kinematics(pose, PlatformVector::Zero(3), kinematics);
  return kinematics;
}

double change_of_log(double before, double after) { return std::log(after / before) / (2.0 * step); }

TEST(PlanarDeterminants, ChangeAsTheirDifferencesDo) {
  for (const RigGeometry geometry : {RigGeometry::nominal, RigGeometry::individual}) {
    const PlanarRrr robot(rig_robot(geometry, RigFriction::none));
    RandomGenerator random(1);
    double largest = 0.0;
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector3d pose(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2),
                                 random.uniform(-0.4, 0.4));
      const Kinematics now = at(robot, pose);
      if (!now.valid || std::abs(now.det_A) < 0.02 || std::abs(now.det_B) < 0.02) continue;
      const auto gradients = robot.determinant_gradients(now);
      ASSERT_TRUE(gradients.has_value());
      for (int axis = 0; axis < 3; ++axis) {
        const Kinematics before = at(robot, pose - step * Eigen::Vector3d::Unit(axis));
        const Kinematics after = at(robot, pose + step * Eigen::Vector3d::Unit(axis));
        const double scale = 1.0 + gradients->log_A.norm() + gradients->log_B.norm();
        largest = std::max(
            largest, std::abs(gradients->log_A[axis] - change_of_log(before.det_A, after.det_A)) / scale);
        largest = std::max(
            largest, std::abs(gradients->log_B[axis] - change_of_log(before.det_B, after.det_B)) / scale);
      }
    }
    EXPECT_LT(largest, 1e-6);
    EXPECT_GT(largest, 0.0) << "no pose was tried";
  }
}

TEST(PlanarDeterminants, HaveNoClosedFormOfOtherMechanismsNorOutOfReach) {
  for (const test::MechanismCase& each : test::mechanism_cases()) {
    Kinematics home;
    each.robot->kinematics(each.robot->home_pose(), PlatformVector::Zero(each.robot->dof()), home);
    const bool is_planar = dynamic_cast<const PlanarRrr*>(each.robot.get()) != nullptr;
    EXPECT_EQ(each.robot->determinant_gradients(home).has_value(), is_planar) << each.name;
  }
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  EXPECT_FALSE(robot.determinant_gradients(at(robot, Eigen::Vector3d(9.0, 0.0, 0.0))).has_value());
}

}  // namespace
}  // namespace flinch
