#include "systems/robot/configuration_space.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <numbers>
#include <random>

#include "systems/robot/rotation.h"
#include "tests/systems/robot/residual.h"

namespace flinch::test {
namespace {

using Kind = ConfigurationSpace::Kind;
constexpr double pi = std::numbers::pi;

class Manifold : public ::testing::TestWithParam<Kind> {
 protected:
  const ConfigurationSpace space = GetParam();
  std::mt19937 generator{17};

  // Rotations below `angle`.
  PlatformVector increment(double angle) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    PlatformVector xi(space.dimension());
    for (double& entry : xi) entry = uniform(generator);
    const int rotations = space.rotations();
    if (rotations > 0) xi.tail(rotations) *= angle / std::sqrt(rotations);
    return xi;
  }
  Configuration anywhere() { return space.plus(space.plus(space.origin(), increment(pi)), increment(pi)); }
};
INSTANTIATE_TEST_SUITE_P(All, Manifold,
                         ::testing::Values(Kind::plane, Kind::space, Kind::planar_pose, Kind::spatial_pose));

TEST_P(Manifold, HasDimensionsThatAddUp) {
  EXPECT_EQ(space.origin().size(), space.stored());
  EXPECT_EQ(space.dimension(), space.translations() + space.rotations());
  EXPECT_TRUE(space.contains(space.origin()));
  EXPECT_EQ(space.rotation_angle(space.origin()), 0.0);
}

TEST_P(Manifold, DifferenceUndoesIncrement) {
  Residual residual("(x (+) xi) (-) x = xi", 2e-15);
  Residual back("b (+) (a (-) b) = a", 2e-15);
  for (int i = 0; i < 1000; ++i) {
    const Configuration x = anywhere();
    const PlatformVector xi = increment(pi - 1e-3);
    const Configuration moved = space.plus(x, xi);
    ASSERT_TRUE(space.contains(moved));
    residual.add((space.difference(moved, x) - xi).lpNorm<Eigen::Infinity>());
    const Configuration y = anywhere();
    const Configuration found = space.plus(x, space.difference(y, x));
    back.add(space.difference(found, y).lpNorm<Eigen::Infinity>());
  }
}

TEST_P(Manifold, DifferenceIsTheShortestWayAndChangesSign) {
  for (int i = 0; i < 1000; ++i) {
    const Configuration a = anywhere();
    const Configuration b = anywhere();
    const PlatformVector xi = space.difference(a, b);
    EXPECT_LE(xi.tail(space.rotations()).norm(), pi + 1e-15);
    EXPECT_LT((xi + space.difference(b, a)).norm(), 1e-14);
  }
}

TEST_P(Manifold, RefusesWhatIsNoConfiguration) {
  const PlatformVector xi = increment(1.0);
  EXPECT_FALSE(space.contains(Configuration()));
  EXPECT_EQ(space.plus(Configuration(), xi), space.origin());
  EXPECT_EQ(space.plus(space.origin(), PlatformVector()), space.origin());
  EXPECT_TRUE(space.difference(space.origin(), Configuration()).isZero(0.0));
  EXPECT_EQ(space.rotation_angle(Configuration()), 0.0);
  for (int i = 0; i < space.stored(); ++i) {
    Configuration x = space.origin();
    x[i] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(space.contains(x));
  }
}

TEST(PlanarPose, WrapsTheOrientationOnly) {
  const ConfigurationSpace space = Kind::planar_pose;
  const PlatformVector d = space.difference(Eigen::Vector3d(4.0, 0.0, 3.0), Eigen::Vector3d(0.0, 0.0, -3.0));
  EXPECT_DOUBLE_EQ(d[0], 4.0);
  EXPECT_NEAR(d[2], 6.0 - 2.0 * pi, 1e-15);
  EXPECT_NEAR(space.rotation_angle(Eigen::Vector3d(4.0, 0.0, -0.7)), 0.7, 1e-16);
}

TEST(SpatialPose, TurnsAboutAxesOfTheBaseFrame) {
  const ConfigurationSpace space = Kind::spatial_pose;
  Eigen::Matrix<double, 6, 1> quarter_about_x;
  quarter_about_x << 1.0, 2.0, 3.0, pi / 2.0, 0.0, 0.0;
  Eigen::Matrix<double, 6, 1> quarter_about_z;
  quarter_about_z << 0.0, 0.0, 0.0, 0.0, 0.0, pi / 2.0;
  const Configuration x = space.plus(space.plus(space.origin(), quarter_about_x), quarter_about_z);
  // x of the platform first stays, then turns to y of the base.
  const Eigen::Matrix3d R = rotation_matrix(x.tail<4>());
  EXPECT_LT((R.col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_EQ(x.head<3>(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(space.rotation_angle(x), 2.0 * pi / 3.0, 1e-15);
}

TEST(SpatialPose, IsTheSameForBothQuaternions) {
  const ConfigurationSpace space = Kind::spatial_pose;
  Configuration a = space.plus(space.origin(), Eigen::Matrix<double, 6, 1>::Constant(0.4));
  Configuration b = a;
  b.tail<4>() *= -1.0;
  EXPECT_TRUE(space.contains(b));
  EXPECT_LT(space.difference(a, b).norm(), 1e-15);
  b.tail<4>() *= 1.001;
  EXPECT_FALSE(space.contains(b));
}

}  // namespace
}  // namespace flinch::test
