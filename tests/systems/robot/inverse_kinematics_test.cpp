#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

class InverseKinematics : public BothGeometries {};
FLINCH_FOR_BOTH_GEOMETRIES(InverseKinematics);

TEST_P(InverseKinematics, ClosesTheLoopOfEveryLeg) {
  const auto legs = reference_legs(GetParam());
  Residual residual("loop closure [m]", 1e-15);
  for (const auto& [pose, velocity] : motions) {
    const InverseSolution solution = robot.inverse_kinematics(pose, robot.home_working_mode());
    ASSERT_TRUE(solution.reachable);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d gap = legs[static_cast<std::size_t>(i)].closure(pose, solution.joints.active[i],
                                                                            solution.joints.passive[i]);
      residual.add(gap.lpNorm<Eigen::Infinity>());
    }
  }
}

TEST_P(InverseKinematics, AgreesWithTheLawOfCosines) {
  const auto legs = reference_legs(GetParam());
  Residual residual("joint angles against the law of cosines [rad]", 1e-14);
  for (const auto& [pose, velocity] : motions) {
    const JointAngles joints = robot.inverse_kinematics(pose, robot.home_working_mode()).joints;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d reference = legs[static_cast<std::size_t>(i)].joints(pose);
      residual.add(joints.active[i] - reference[0]);
      residual.add(joints.passive[i] - reference[1]);
      residual.add(joints.coupling[i] - reference[2]);
    }
  }
}

TEST_P(InverseKinematics, ClosesTheLoopInEveryWorkingMode) {
  const auto legs = reference_legs(GetParam());
  Residual residual("loop closure, all eight working modes [m]", 1e-15);
  for (int bits = 0; bits < 8; ++bits) {
    const WorkingMode mode{{bits & 1 ? 1 : 0, bits & 2 ? 1 : 0, bits & 4 ? 1 : 0}};
    const InverseSolution solution = robot.inverse_kinematics(Eigen::Vector3d(0.03, -0.05, 0.1), mode);
    ASSERT_TRUE(solution.reachable);
    EXPECT_EQ(robot.working_mode(solution.joints.passive), mode);
    for (int i = 0; i < 3; ++i) {
      residual.add(legs[static_cast<std::size_t>(i)]
                       .closure({0.03, -0.05, 0.1}, solution.joints.active[i], solution.joints.passive[i])
                       .norm());
    }
  }
}

TEST(InverseKinematicsAtHome, HasThePublishedAngles) {
  const PlanarRrr individual(rig_robot(RigGeometry::individual, RigFriction::none));
  const JointAngles joints =
      individual.inverse_kinematics(individual.home_pose(), individual.home_working_mode()).joints;
  EXPECT_TRUE(joints.active.isApprox(Eigen::Vector3d(25.518, 25.963, 24.379) * degree, 5e-5));
  EXPECT_TRUE(joints.passive.isApprox(Eigen::Vector3d(122.305, 121.775, 124.609) * degree, 1e-5));

  const PlanarRrr nominal(rig_robot(RigGeometry::nominal, RigFriction::none));
  const JointAngles equal =
      nominal.inverse_kinematics(nominal.home_pose(), nominal.home_working_mode()).joints;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(equal.active[i] / degree, 25.251, 5e-4);
    EXPECT_NEAR(equal.passive[i] / degree, 122.819, 5e-4);
  }
}

TEST(InverseKinematicsAtHome, OtherElbowSideLeavesTheJointRange) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  const WorkingMode other = WorkingMode::Ones(3);
  EXPECT_NEAR(robot.inverse_kinematics(robot.home_pose(), other).joints.active[0] / degree, 154.5, 0.5);
}

TEST(InverseKinematicsOutOfReach, EndsExactlyWhereALegIsStretched) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  const double stretched =
      0.6829 - 0.107 - (0.5816 + 0.6198);  // x at which leg 1 points straight at the platform
  EXPECT_TRUE(robot.inverse_kinematics(Eigen::Vector3d(stretched + 1e-9, 0.0, 0.0), robot.home_working_mode())
                  .joints.passive.allFinite());
  EXPECT_FALSE(
      robot.inverse_kinematics(Eigen::Vector3d(stretched - 1e-9, 0.0, 0.0), robot.home_working_mode())
          .reachable);
}

}  // namespace
}  // namespace flinch::test
