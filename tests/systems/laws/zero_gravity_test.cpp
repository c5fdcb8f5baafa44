#include "systems/laws/zero_gravity.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/framework/diagram_builder.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

struct Law {
  Law()
      : block(builder.add<ZeroGravity>("zero_gravity")),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        dynamics(builder.export_input("dynamics", block.dynamics)) {}

  const TorqueCommand& at(const Kinematics& where, const Dynamics& model) {
    ticking.set(kinematics, where);
    ticking.set(dynamics, model);
    ticking.tick();
    return ticking.get(block.torque);
  }

  DiagramBuilder builder;
  ZeroGravity& block;
  InputPort<Kinematics> kinematics;
  InputPort<Dynamics> dynamics;
  test::Ticking ticking{builder};
};

TEST(ZeroGravity, IsNoTorqueForARobotThatMovesHorizontally) {
  const test::Posture posture(*test::planar_rig(), Eigen::Vector3d(0.05, -0.03, 0.1),
                              Eigen::Vector3d(1, 1, 1));
  Law law;
  const TorqueCommand& command = law.at(posture.kinematics, posture.dynamics);
  EXPECT_TRUE(command.valid);
  EXPECT_EQ(command.torque, JointVector::Zero(3));
}

TEST(ZeroGravity, DoesThePowerOfGravityAndNothingElse) {
  test::Posture posture(*test::planar_rig(), Eigen::Vector3d(0.05, -0.03, 0.1),
                        Eigen::Vector3d(0.3, -0.2, 0.5));
  posture.dynamics.g_x = Eigen::Vector3d(3.0, -7.0, 0.4);  // as if the robot stood upright
  Law law;
  const TorqueCommand& command = law.at(posture.kinematics, posture.dynamics);
  ASSERT_TRUE(command.valid);
  EXPECT_NEAR(command.torque.dot(posture.motion.velocity),
              posture.dynamics.g_x.dot(posture.platform.velocity), 1e-12);
}

TEST(ZeroGravity, IsNotValidWithoutAModel) {
  test::Posture posture(*test::planar_rig());
  Law law;
  EXPECT_FALSE(law.at(Kinematics(), posture.dynamics).valid);
  EXPECT_FALSE(law.at(posture.kinematics, Dynamics()).valid);
  posture.dynamics.g_x[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(law.at(posture.kinematics, posture.dynamics).valid);
}

TEST(ZeroGravity, NeverAllocates) {
  const test::Posture posture(*test::planar_rig());
  Law law;
  law.at(posture.kinematics, posture.dynamics);
  const test::AllocationCounter counter;
  law.ticking.tick();
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
