#include "systems/contact/wrench_uncertainty.h"

#include <gtest/gtest.h>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

constexpr ConfigurationSpace space = ConfigurationSpace::Kind::planar_pose;
const PlatformVector none = PlatformVector::Zero(3);

// Against draws: what torques that err make the wrench of a robot err by, [spec] F = J^T tau.
TEST(WrenchUncertainty, OfDrivesIsThatOfDrawnErrors) {
  const auto robot = test::touched_rig();
  const Kinematics at = test::at_home(*robot);
  const WrenchUncertainty uncertainty{.drive_torque = Eigen::Vector3d(0.3, 0.1, 0.5)};
  const PlatformMatrix S = uncertainty.covariance(space, at, none);
  RandomGenerator random(1);
  PlatformMatrix drawn = PlatformMatrix::Zero(3, 3);
  constexpr int draws = 20'000;
  for (int i = 0; i < draws; ++i) {
    JointVector error = uncertainty.drive_torque;
    for (double& each : error) each *= random.normal();
    const PlatformVector F = at.J_qa_x.transpose() * error;
    drawn += F * F.transpose() / draws;
  }
  EXPECT_LT((drawn - S).norm(), 0.05 * S.norm());
  EXPECT_GT(std::abs(S(0, 2)), 0.01 * std::sqrt(S(0, 0) * S(2, 2))) << "they are correlated";
}

TEST(WrenchUncertainty, GrowsWithTheForceHoweverItIsKnown) {
  const auto robot = test::touched_rig();
  const Kinematics at = test::at_home(*robot);
  const PlatformVector F{{30.0, 40.0, 1.0}};
  const Eigen::Vector3d grown(6.25, 6.25, 0.04);  // 0.05 x 50 N, and 0.004 m x 50 N, squared
  for (const WrenchUncertainty& each :
       {WrenchUncertainty{}, WrenchUncertainty{.drive_torque = Eigen::Vector3d(0.3, 0.1, 0.5)}}) {
    const PlatformMatrix by = each.covariance(space, at, F) - each.covariance(space, at, none);
    EXPECT_LT((by - PlatformMatrix(grown.asDiagonal())).norm(), 1e-12);
  }
}

TEST(WrenchUncertainty, IsThatOfForceAndMomentWhereThePoseOrTheDrivesAreNotKnown) {
  const auto robot = test::touched_rig();
  const Kinematics at = test::at_home(*robot);
  const WrenchUncertainty isotropic, of_drives{.drive_torque = Eigen::Vector3d::Ones()},
      of_another{.drive_torque = Eigen::Vector2d::Ones()};
  const PlatformMatrix S = isotropic.covariance(space, none);
  EXPECT_EQ(isotropic.covariance(space, at, none), S);
  EXPECT_EQ(of_drives.covariance(space, Kinematics(), none), S);
  EXPECT_EQ(of_another.covariance(space, at, none), S);
}

TEST(WrenchUncertainty, NeverAllocates) {
  const auto robot = test::touched_rig();
  const Kinematics at = test::at_home(*robot);
  const WrenchUncertainty uncertainty{.drive_torque = Eigen::Vector3d::Ones()};
  const test::AllocationCounter allocations;
  EXPECT_GT(uncertainty.errors(space, at, none, none).trace(), 0.0);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
