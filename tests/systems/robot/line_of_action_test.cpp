#include "systems/robot/line_of_action.h"
#include "systems/robot/decompositions.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class LineOfActionLaws : public MechanismLaws {
 protected:
  /// Forces of 20 N in random directions on points of all bodies in all states, as the platform feels them.
  template <class See>
  void for_each_contact(const See& see) {
    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    for (const MotionState& state : states) {
      const Kinematics k = kinematics_at(state.pose, state.velocity);
      for (const auto& [body, point] : points()) {
        CartesianVector force =
            CartesianVector::NullaryExpr(robot.space_dimension(), [&] { return normal(generator); });
        force *= 20.0 / force.norm();
        see(k, body, robot.point_on_body(k, body, point), force,
            platform_wrench(robot.contact_jacobian(k, body, point), force));
      }
    }
  }
  /// Whether the platform turns, though none of its coordinates is an angle.
  bool turns_by_following() const {
    const MotionState& state = states.front();
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const CartesianVector origin = CartesianVector::Zero(robot.space_dimension());
    return space.rotations() == 0 &&
           !robot.contact_jacobian(k, BodyId::platform(), origin).rotation.isZero(1e-12);
  }
  CartesianVector origin_of(const Kinematics& k) const { return k.pose.head(robot.space_dimension()); }
};
FLINCH_FOR_ALL_MECHANISMS(LineOfActionLaws);

// Where the orientation follows, a force off the platform's origin makes one that is not its own.
TEST_P(LineOfActionLaws, AForceOnThePlatformActsAlongTheLineThroughItsPoint) {
  if (turns_by_following()) GTEST_SKIP() << "its wrench holds what turns it as well";
  Residual distance("of the point from the line [m]", 1e-12);
  Residual angle("between line and force", 1e-12);
  for_each_contact([&](const Kinematics& k, BodyId body, const CartesianVector& point,
                       const CartesianVector& force, const PlatformVector& wrench) {
    if (!body.is_platform()) return;
    const LineOfAction line = line_of_action(space, wrench, 1.0);
    ASSERT_TRUE(line.valid);
    EXPECT_EQ(line.has_lever, space.rotations() > 0);
    angle.add((line.direction - force / 20.0).norm());
    distance.add(line.has_lever ? distance_to_line(line, origin_of(k), point) : 0.0);
    EXPECT_LT(line.moment_along_force, 1e-12);
  });
}

TEST_P(LineOfActionLaws, AForceOnALegActsThroughItsCouplingJoint) {
  if (space.rotations() == 0) GTEST_SKIP() << "the platform cannot be turned: its wrench has no line";
  Residual distance("of the coupling joint from the line [m]", 1e-9);
  for_each_contact([&](const Kinematics& k, BodyId body, const CartesianVector&, const CartesianVector&,
                       const PlatformVector& wrench) {
    const LineOfAction line = line_of_action(space, wrench, 1.0);
    if (body.is_platform() || !line.valid) return;
    const LegPoints& leg = k.legs[static_cast<std::size_t>(body.leg())];
    distance.add(distance_to_line(line, origin_of(k), leg.coupling_joint));
  });
}

// [SafePR] (15) as printed: the pseudo-inverse of S^T(f) of the moment.
TEST_P(LineOfActionLaws, TheLeverIsThatOfThePseudoInverse) {
  if (space.rotations() == 0) GTEST_SKIP() << "no moments";
  Residual lever("of the lever [m]", 1e-12);
  for_each_contact([&](const Kinematics&, BodyId, const CartesianVector&, const CartesianVector&,
                       const PlatformVector& wrench) {
    const LineOfAction line = line_of_action(space, wrench, 1.0);
    if (!line.valid) return;
    Eigen::Vector3d f = Eigen::Vector3d::Zero();
    f.head(space.translations()) = wrench.head(space.translations());
    Eigen::MatrixXd moment_of_lever(space.rotations(), space.translations());  // r -> r x f
    for (int column = 0; column < space.translations(); ++column) {
      const Eigen::Vector3d moment = Eigen::Vector3d::Unit(column).cross(f);
      moment_of_lever.col(column) = moment.tail(space.rotations());
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(moment_of_lever, Eigen::ComputeThinU | Eigen::ComputeThinV);
    compare(lever, line.lever, CartesianVector(svd.solve(wrench.tail(space.rotations()))));
  });
}

TEST_P(LineOfActionLaws, WithoutAForceThereIsNoLineAndNothingThatIsNotANumber) {
  PlatformVector pure_moment = PlatformVector::Zero(n);
  pure_moment.tail(space.rotations()).setConstant(5.0);
  const PlatformVector unusable[] = {PlatformVector::Zero(n),
                                     pure_moment,
                                     PlatformVector::Constant(n, nan),
                                     PlatformVector::Constant(n - 1, 10.0),
                                     PlatformVector(),
                                     PlatformVector::Constant(n, 1e300)};
  for (const PlatformVector& wrench : unusable) {
    for (const double least_force : {1.0, 0.0}) {
      const LineOfAction line = line_of_action(space, wrench, least_force);
      EXPECT_FALSE(line.valid);
      EXPECT_EQ(line.lever, CartesianVector::Zero(space.translations()));
      EXPECT_EQ(line.direction, CartesianVector::Zero(space.translations()));
    }
  }
}

TEST(LineOfAction, OfAPushFromTheRightAboveTheOrigin) {
  const LineOfAction line =
      line_of_action(ConfigurationSpace::Kind::planar_pose, PlatformVector{{-10.0, 0.0, 0.5}}, 1.0);
  EXPECT_TRUE(line.valid);
  EXPECT_EQ(line.direction, CartesianVector(Eigen::Vector2d(-1.0, 0.0)));
  EXPECT_NEAR(line.lever[0], 0.0, 1e-15);
  EXPECT_NEAR(line.lever[1], 0.05, 1e-15);  // 10 N to the left at 5 cm above turn by +0.5 Nm
  const CartesianVector point = Eigen::Vector2d(1.0, 2.15);
  EXPECT_NEAR(distance_to_line(line, Eigen::Vector2d(1.0, 2.0), point), 0.10, 1e-15);
}

TEST(LineOfAction, TellsAMomentThatNoSingleForceMakes) {
  const PlatformVector screw{{0.0, 0.0, 10.0, 3.0, 0.0, 4.0}};
  EXPECT_NEAR(line_of_action(ConfigurationSpace::Kind::spatial_pose, screw, 1.0).moment_along_force, 0.8,
              1e-15);
}

TEST(AngleBetween, CountsFromZeroToPiAndIsExactAtBothEnds) {
  const CartesianVector x = Eigen::Vector2d(2.0, 0.0);
  EXPECT_EQ(angle_between(x, x), 0.0);
  EXPECT_NEAR(angle_between(x, Eigen::Vector2d(0.0, -3.0)), std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(angle_between(x, Eigen::Vector2d(-1.0, 1e-9)), std::numbers::pi - 1e-9, 1e-15);
  EXPECT_EQ(angle_between(x, Eigen::Vector2d::Zero()), 0.0);
}

}  // namespace
}  // namespace flinch::test
