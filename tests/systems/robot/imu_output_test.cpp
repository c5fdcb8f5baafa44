#include "systems/robot/imu_output.h"

#include <gtest/gtest.h>

#include "systems/framework/random.h"

namespace flinch {
namespace {

using Kind = ConfigurationSpace::Kind;

/// A random motion in a space.
struct Motion {
  Configuration pose;
  PlatformVector velocity, acceleration;

  Motion(ConfigurationSpace space, RandomGenerator& random) {
    const auto draw = [&](double size) -> PlatformVector {
      return PlatformVector::NullaryExpr(space.dimension(), [&] { return random.uniform(-size, size); });
    };
    pose = space.plus(space.origin(), draw(1.0));
    velocity = draw(3.0);
    acceleration = draw(20.0);
  }
  ImuOutput output(ConfigurationSpace space) const {
    const ImuMount mount{{0.075, 0.054, -0.097}, {0.3, -0.2, 0.5}};
    return imu_output(space, mount, {0.3, -0.2, -9.81}, pose, velocity, acceleration);
  }
};

class ImuOutputIn : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Of, ImuOutputIn,
                         testing::Values(Kind::plane, Kind::space, Kind::planar_pose, Kind::spatial_pose));

TEST_P(ImuOutputIn, ChangesAsItsJacobiansSay) {
  const ConfigurationSpace space = GetParam();
  RandomGenerator random(3);
  constexpr double h = 1e-5;
  for (int trial = 0; trial < 100; ++trial) {
    const Motion motion(space, random);
    const ImuOutput at = motion.output(space);
    const auto slope = [&](auto change) -> Eigen::Matrix<double, 6, 1> {
      Motion less = motion, more = motion;
      change(less, -h);
      change(more, h);
      return (more.output(space).value - less.output(space).value) / (2.0 * h);
    };
    for (int j = 0; j < space.dimension(); ++j) {
      const PlatformVector unit = PlatformVector::Unit(space.dimension(), j);
      const auto by_pose =
          slope([&](Motion& moved, double by) { moved.pose = space.plus(moved.pose, by * unit); });
      const auto by_velocity = slope([&](Motion& moved, double by) { moved.velocity[j] += by; });
      const auto by_acceleration = slope([&](Motion& moved, double by) { moved.acceleration[j] += by; });
      ASSERT_LT((by_pose - at.by_pose.col(j)).norm(), 1e-7) << j;
      ASSERT_LT((by_velocity - at.by_velocity.col(j)).norm(), 1e-7) << j;
      ASSERT_LT((by_acceleration - at.by_acceleration.col(j)).norm(), 1e-7) << j;
    }
  }
}

// [RAL25] (9) written out for a plane: c x'' + s y'' - phi'' p_y - phi'^2 p_x and so on, and 9.81 upwards.
TEST(ImuOutput, IsThatOfThePaperInAPlane) {
  const double c = std::cos(0.4), s = std::sin(0.4), rate = 2.0, x = 5.0, y = -3.0, phi = 30.0;
  const ImuMount mount{{0.075, 0.054, -0.097}, {0.0, 0.0, 0.0}};
  const ImuOutput output =
      imu_output(Kind::planar_pose, mount, {0.0, 0.0, -9.81}, PlatformVector{{0.1, 0.2, 0.4}},
                 PlatformVector{{1.0, 2.0, rate}}, PlatformVector{{x, y, phi}});
  Eigen::Matrix<double, 6, 1> expected;
  expected << 0.0, 0.0, rate, c * x + s * y - phi * 0.054 - rate * rate * 0.075,
      -s * x + c * y + phi * 0.075 - rate * rate * 0.054, 9.81;
  EXPECT_LT((output.value - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace flinch
