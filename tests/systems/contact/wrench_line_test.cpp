#include "systems/contact/wrench_line.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

constexpr ConfigurationSpace in_space = ConfigurationSpace::Kind::spatial_pose;

PlatformMatrix covariance(double force, double moment) {
  PlatformMatrix S = PlatformMatrix::Zero(6, 6);
  S.diagonal() << force, force, force, moment, moment, moment;
  return S.cwiseProduct(S);
}

PlatformVector wrench_of(const Eigen::Vector3d& force, const Eigen::Vector3d& at) {
  PlatformVector wrench(6);
  wrench << force, at.cross(force);
  return wrench;
}

TEST(WrenchLine, PassesThroughThePointWhereTheForceActs) {
  const Eigen::Matrix3d turned(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  const Eigen::Vector3d force(10.0, -20.0, 5.0), at(0.1, 0.2, -0.05);
  const WrenchLine line(in_space, wrench_of(force, at), covariance(1.0, 0.1), turned);
  const Eigen::Vector3d in_platform = turned.transpose() * at;
  EXPECT_LT((in_platform - line.point).cross(line.direction).norm(), 1e-12);
  EXPECT_LT((line.direction - turned.transpose() * force.normalized()).norm(), 1e-12);
  EXPECT_TRUE(line.passes(in_platform));
}

// 0.1 Nm are 5 mm at 20 N.
TEST(WrenchLine, ReachesThreeDeviationsOfItsMomentOverItsForce) {
  const WrenchLine line(in_space, wrench_of({20.0, 0.0, 0.0}, {0.0, 0.0, 0.0}), covariance(1.0, 0.1),
                        Eigen::Matrix3d::Identity());
  EXPECT_NEAR(line.reach, 0.015, 1e-12);
  for (const Eigen::Vector3d& across : line.across) {
    EXPECT_NEAR(across.dot(line.direction), 0.0, 1e-12);
    EXPECT_TRUE(line.passes(line.point + 0.0149 * across + 3.0 * line.direction));
    EXPECT_FALSE(line.passes(line.point - 0.0151 * across));
  }
}

TEST(WrenchLine, IsAnywhereWithoutAForce) {
  const WrenchLine line(in_space, PlatformVector::Zero(6), covariance(1.0, 0.1), Eigen::Matrix3d::Identity());
  EXPECT_FALSE(line.reach < 1.0);
}

}  // namespace
}  // namespace flinch
