#include "systems/laws/controlled_stop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const TorqueCommand gravity{.computed = {}, .valid = true, .torque = Eigen::Vector3d(1.0, 2.0, -3.0)};
const JointMotion moving{.acquired = {},
                         .valid = true,
                         .position = Eigen::Vector3d::Zero(),
                         .velocity = Eigen::Vector3d(0.5, -1.0, 2.0)};

struct Law {
  explicit Law(const ControlledStopSettings& settings = {.damping = 10.0})
      : block(builder.add<ControlledStop>("stop", test::planar_rig(), settings)),
        zero_gravity(builder.export_input("zero_gravity", block.zero_gravity)),
        joints(builder.export_input("joints", block.joints)) {}

  const TorqueCommand& at(const TorqueCommand& compensation, const JointMotion& motion) {
    ticking.set(zero_gravity, compensation);
    ticking.set(joints, motion);
    ticking.tick();
    return ticking.get(block.torque);
  }

  DiagramBuilder builder;
  ControlledStop& block;
  InputPort<TorqueCommand> zero_gravity;
  InputPort<JointMotion> joints;
  test::Ticking ticking{builder};
};

TEST(ControlledStop, DampsEveryDriveAndCompensatesGravity) {
  Law law;
  const TorqueCommand& command = law.at(gravity, moving);
  EXPECT_TRUE(command.valid);
  EXPECT_EQ(command.torque, Eigen::Vector3d(1.0 - 5.0, 2.0 + 10.0, -3.0 - 20.0));
}

TEST(ControlledStop, GoesOnWithTheLastGravityThatWasKnown) {
  Law law;
  law.at(gravity, moving);
  const TorqueCommand& command = law.at({.computed = {}, .valid = false, .torque = {}}, moving);
  EXPECT_TRUE(command.valid);
  EXPECT_EQ(command.torque, Eigen::Vector3d(-4.0, 12.0, -23.0));
}

TEST(ControlledStop, IsNotValidBeforeGravityIsKnown) {
  EXPECT_FALSE(Law().at({.computed = {}, .valid = false, .torque = {}}, moving).valid);
}

TEST(ControlledStop, IsNotValidWithoutRates) {
  Law law;
  law.at(gravity, moving);
  JointMotion lost = moving;
  lost.valid = false;
  EXPECT_FALSE(law.at(gravity, lost).valid);
  lost = moving;
  lost.velocity[1] = nan;
  EXPECT_FALSE(law.at(gravity, lost).valid);
  lost.velocity = Eigen::Vector2d::Zero();
  EXPECT_FALSE(law.at(gravity, lost).valid);
}

TEST(ControlledStop, BrakesLessWhereTheRobotIsSlow) {
  Law law({.damping = 10.0, .whole_from = 2.0, .share_at_rest = 0.25});
  JointMotion slow = moving;
  slow.velocity = Eigen::Vector3d(0.5, -1.0, 0.0);  // half of `whole_from`
  EXPECT_EQ(law.at(gravity, slow).torque, Eigen::Vector3d(1.0 - 2.5, 2.0 + 5.0, -3.0));
  slow.velocity *= 0.1;  // a quarter of the damping is left
  EXPECT_TRUE(law.at(gravity, slow).torque.isApprox(Eigen::Vector3d(1.0 - 0.125, 2.0 + 0.25, -3.0)));
}

/// What a hand must press with on the middle of the platform to lead it with `velocity`, the platform free to
/// turn meanwhile [N].
double hand_force(const ParallelRobot& robot, const Eigen::Vector3d& pose, Eigen::Vector3d velocity,
                  Law& law) {
  test::Posture posture(robot, pose, velocity);
  const Eigen::Matrix3d J = posture.kinematics.J_qa_x;
  const Eigen::Matrix3d damping = J.transpose() * J;
  velocity[2] = -damping.row(2).head<2>().dot(velocity.head<2>()) / damping(2, 2);
  posture = test::Posture(robot, pose, velocity);
  const TorqueCommand none{.computed = {}, .valid = true, .torque = JointVector::Zero(3)};
  const PlatformVector braking = J.transpose() * law.at(none, posture.motion).torque;
  return (posture.dynamics.F_fr_x - braking).head<2>().norm();
}

TEST(ControlledStop, LeavesARobotThatCanBePushedByHand) {
  constexpr double speed = 0.1;  // [m/s]
  const auto robot = test::planar_rig(RigFriction::test_rig);
  Law law({.share_at_rest = 0.25});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double largest = 0.0;
  for (int i = 0; i < 5000;) {
    const Eigen::Vector3d pose(0.3 * unit(random), 0.3 * unit(random), 0.45 * unit(random));
    const double direction = 3.14 * unit(random);
    const test::Posture posture(*robot, pose);
    if (!posture.kinematics.valid || posture.kinematics.sigma_kappa > 15.0) continue;
    ++i;
    const Eigen::Vector3d velocity(speed * std::cos(direction), speed * std::sin(direction), 0.0);
    largest = std::max(largest, hand_force(*robot, pose, velocity, law));
  }
  RecordProperty("largest_N", std::to_string(largest));
  EXPECT_LE(largest, 15.0);
}

TEST(ControlledStop, NeverAllocates) {
  Law law;
  law.at(gravity, moving);
  const test::AllocationCounter counter;
  law.at(gravity, moving);
  EXPECT_EQ(counter.count(), 0);
}

TEST(ControlledStop, RefusesADampingThatIsNotPositive) {
  EXPECT_THROW(ControlledStop(test::planar_rig(), {.damping = 0.0}), SetupError);
  EXPECT_THROW(ControlledStop(test::planar_rig(), {.damping = nan}), SetupError);
  EXPECT_THROW(ControlledStop(test::planar_rig(), {.whole_from = 0.0}), SetupError);
  EXPECT_THROW(ControlledStop(test::planar_rig(), {.share_at_rest = 0.0}), SetupError);
}

}  // namespace
}  // namespace flinch
