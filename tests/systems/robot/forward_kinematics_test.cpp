#include "systems/robot/angles.h"
#include "tests/systems/robot/random_motion.h"
#include "tests/systems/robot/reference_3rrr.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

class ForwardKinematics : public BothGeometries {
 protected:
  JointAngles joints_at(const Eigen::Vector3d& pose) const {
    return robot.inverse_kinematics(pose, robot.home_working_mode()).joints;
  }
};
FLINCH_FOR_BOTH_GEOMETRIES(ForwardKinematics);

TEST_P(ForwardKinematics, RecoversThePoseFromRoughPassiveAnglesWithinFourIterations) {
  std::mt19937 generator(7);
  std::normal_distribution<double> noise(0.0, 0.1 * std::numbers::pi / 180.0);
  Residual residual("pose, started from passive angles with 0.1 deg noise", 1e-13);
  Residual iterations("iterations", 4);
  for (const auto& [pose, velocity] : motions) {
    JointAngles joints = joints_at(pose);
    for (double& angle : joints.passive) angle += noise(generator);
    const ForwardSolution solution = robot.forward_kinematics(
        joints.active, robot.start_pose(joints.active, joints.passive), robot.working_mode(joints.passive));
    ASSERT_TRUE(solution.converged);
    residual.add(robot.difference(solution.pose, pose), Eigen::Vector3d(0, 0, 0));
    iterations.add(solution.iterations);
  }
}

TEST_P(ForwardKinematics, RecoversThePoseFromActiveAnglesAndThePreviousPose) {
  Residual residual("pose, started one millisecond earlier", 1e-13);
  Residual iterations("iterations", 4);
  for (const auto& [pose, velocity] : motions) {
    const Eigen::Vector3d previous = pose - 1e-3 * velocity;
    const ForwardSolution solution =
        robot.forward_kinematics(joints_at(pose).active, previous, robot.home_working_mode());
    ASSERT_TRUE(solution.converged);
    residual.add(robot.difference(solution.pose, pose), Eigen::Vector3d(0, 0, 0));
    iterations.add(solution.iterations);
  }
}

TEST_P(ForwardKinematics, DependsOnTheActiveAnglesOnly) {
  Residual residual("pose from two different starts [m, rad]", 1e-13);
  for (const PoseAndVelocity& motion : motions) {
    const auto& pose = motion.pose;
    const JointVector active = joints_at(pose).active;
    const auto from = [&](const Eigen::Vector3d& start) {
      return robot.forward_kinematics(active, start, robot.home_working_mode());
    };
    const ForwardSolution a = from(pose + Eigen::Vector3d(0.004, -0.003, 0.01));
    const ForwardSolution b = from(pose - Eigen::Vector3d(0.004, -0.003, 0.01));
    ASSERT_TRUE(a.converged && b.converged);
    residual.add(robot.difference(a.pose, b.pose), Eigen::Vector3d(0, 0, 0));
  }
}

// Far away the iteration is on the drive angles, next to the pose on the lengths of the second links.
TEST_P(ForwardKinematics, FindsFromFarAwayWhatItFindsFromNextToIt) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Residual residual("pose from a start far away and from the pose itself [m, rad]", 1e-13);
  int compared = 0;
  for (const auto& [pose, velocity] : motions) {
    const JointVector active = joints_at(pose).active;
    const Eigen::Vector3d away(0.08 * uniform(generator), 0.08 * uniform(generator),
                               0.3 * uniform(generator));
    const ForwardSolution near = robot.forward_kinematics(active, pose, robot.home_working_mode());
    const ForwardSolution far = robot.forward_kinematics(active, pose + away, robot.home_working_mode());
    ASSERT_TRUE(near.converged);
    if (!far.converged) continue;
    ++compared;
    residual.add(robot.difference(far.pose, near.pose), Eigen::Vector3d(0, 0, 0));
  }
  EXPECT_GT(compared, 250);
}

// The second links have their lengths there, but elbows are on the other side.
TEST_P(ForwardKinematics, HasNoSolutionWithElbowsOnTheOtherSide) {
  const WorkingMode home = robot.home_working_mode();
  int flipped = 0;
  for (const auto& [pose, velocity] : motions) {
    WorkingMode other = home;
    other[flipped % 3] = 1 - home[flipped % 3];
    const InverseSolution drives = robot.inverse_kinematics(pose, other);
    ASSERT_TRUE(drives.reachable);
    ++flipped;
    const ForwardSolution solution = robot.forward_kinematics(drives.joints.active, pose, home);
    if (solution.converged) {
      EXPECT_GT(robot.difference(solution.pose, pose).norm(), 1e-3);
    }
    EXPECT_TRUE(robot.forward_kinematics(drives.joints.active, pose, other).converged);
  }
}

TEST_P(ForwardKinematics, ConvergedMeansThatTheDriveAnglesAreReproduced) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> angle(-0.6, 2.6);
  const auto legs = reference_legs(GetParam());
  int converged = 0;
  Residual residual("drive angles at the pose found [rad]", 1e-13);
  for (int trial = 0; trial < 3000; ++trial) {
    const Eigen::Vector3d active(angle(generator), angle(generator), angle(generator));
    const ForwardSolution solution =
        robot.forward_kinematics(active, robot.home_pose(), robot.home_working_mode());
    ASSERT_TRUE(solution.pose.allFinite());
    ASSERT_LE(solution.iterations, 10);
    if (!solution.converged) continue;
    ++converged;
    for (int i = 0; i < 3; ++i) {
      const double found = legs[static_cast<std::size_t>(i)].joints(solution.pose)[0];
      residual.add(wrap_angle(found - active[i]));
    }
  }
  EXPECT_GT(converged, 100);
  EXPECT_LT(converged, 3000);
}

TEST_P(ForwardKinematics, SaysSoWhenThereIsNoPose) {
  const WorkingMode mode = robot.home_working_mode();
  const Eigen::Vector3d apart(2.6, 2.6, -0.6);
  EXPECT_FALSE(robot.forward_kinematics(apart, robot.home_pose(), mode).converged);
  const Eigen::Vector3d out_of_reach(9.0, 0.0, 0.0);
  EXPECT_FALSE(robot.forward_kinematics(Eigen::Vector3d(0.4, 0.4, 0.4), out_of_reach, mode).converged);
}

TEST_P(ForwardKinematics, ChainClosureErrorShowsAJointThatHasComeApart) {
  for (const auto& [pose, velocity] : motions) {
    PlanarMotion motion = robot.motion(pose, velocity);
    EXPECT_LT(robot.chain_closure_error(motion), 1e-14);
    motion.legs[2].leg.coupling_joint.y() += 2e-3;
    EXPECT_NEAR(robot.chain_closure_error(motion), 2e-3, 1e-14);
  }
}

TEST_P(ForwardKinematics, ChainClosureErrorShowsABadEncoder) {
  for (const auto& [pose, velocity] : motions) {
    JointAngles joints = joints_at(pose);
    EXPECT_LT(robot.chain_closure_error(joints.active, joints.passive, pose), 1e-14);
    joints.passive[1] += 0.03;  // moves the tip by 0.03 rad times the length of the second link
    const double error = robot.chain_closure_error(joints.active, joints.passive, pose);
    EXPECT_GT(error, 0.0185 / std::numbers::sqrt2 - 1e-4);
    EXPECT_LT(error, 0.0187);
  }
}

TEST_P(ForwardKinematics, WorkingModeIsTheSignOfThePassiveAngles) {
  EXPECT_EQ(robot.working_mode(Eigen::Vector3d(2.0, -0.1, 0.0)), (WorkingMode{{0, 1, 0}}));
}

}  // namespace
}  // namespace flinch::test
