#include "plant/rope_pull.h"

#include <gtest/gtest.h>

#include "plant/rig_dynamics.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

const RopePull pull{
    .body = 0, .peak_in_base = {40.0, 0.0, -10.0}, .start = 1s, .rise = 2s, .hold = 500ms, .fall = 4s};

TEST(RopePull, RisesHoldsAndFalls) {
  EXPECT_TRUE(pull.at(0.999).isZero());
  EXPECT_TRUE(pull.at(2.0).isApprox(Eigen::Vector3d(20.0, 0.0, -5.0)));
  EXPECT_TRUE(pull.at(3.2).isApprox(pull.peak_in_base));
  EXPECT_TRUE(pull.at(5.5).isApprox(0.5 * pull.peak_in_base));
  EXPECT_TRUE(pull.at(7.5).isZero());
}

/// What the ropes do to the platform at the start, by the rig and by the Jacobian of the point.
void compare(const std::shared_ptr<const Mechanism>& robot, int body, const Eigen::Vector3d& point) {
  RigSettings settings;
  settings.robot = robot;
  settings.pulls = {RopePull{.body = body,
                             .point_in_body = point,
                             .peak_in_base = {30.0, -20.0, robot->space_dimension() == 3 ? 10.0 : 0.0},
                             .start = 0s,
                             .rise = 0s,
                             .hold = 1s,
                             .fall = 0s}};
  const auto rig = RigDynamics::make(settings);
  RigSnapshot now;
  const PlatformVector nothing = PlatformVector::Zero(robot->dof());
  rig->snapshot(rig->initial_state(), {}, nothing, rig->initial_step(), 1e-3, now);
  Kinematics at;
  robot->kinematics(robot->home_pose(), nothing, at);
  const int directions = robot->space_dimension();
  const ContactJacobian map = robot->contact_jacobian(at, BodyId::from_index(body), point.head(directions));
  const PlatformVector expected =
      platform_wrench(map, CartesianVector(settings.pulls[0].peak_in_base.head(directions)));
  EXPECT_LT((now.applied_wrench - expected).norm(), 1e-9) << robot->name() << ", body " << body;
}

TEST(RopePull, ActsOnThePlatformAsTheJacobianOfItsPointSays) {
  for (int body = 0; body < 7; ++body) compare(test::individual_rig(), body, {0.3, 0.05, 0.0});
  for (int body = 0; body < 13; ++body) {
    compare(std::make_shared<const Hexapod>(hexapod_robot()), body, {0.02, 0.03, 0.1});
  }
}

TEST(RopePull, AtNoBodyIsRefused) {
  RigSettings settings;
  settings.robot = test::individual_rig();
  settings.pulls = {RopePull{.body = 7}};
  EXPECT_EQ(problems(settings), std::vector<std::string>{"a rope pulls at a body that the robot has not"});
}

}  // namespace
}  // namespace flinch
