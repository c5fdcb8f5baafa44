#include "systems/robot/link_contact.h"
#include "systems/robot/decompositions.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/systems/robot/mechanism_laws.h"
#include "tests/systems/robot/random_motion.h"

namespace flinch::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class LinkContactLaws : public MechanismLaws {};
FLINCH_FOR_ALL_MECHANISMS(LinkContactLaws);

TEST_P(LinkContactLaws, TheMapIsThatOfTheContactJacobianAnywhereOnTheLink) {
  Residual wrenches("of the wrench [N, Nm]", 1e-11);
  Residual points("of the point [m]", 1e-12);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    for (int i = 1; i < robot.body_count(); ++i) {
      const BodyId link = BodyId::from_index(i);
      const LinkContactMap map = link_contact_map(robot, k, link);
      ASSERT_TRUE(map.valid);
      for (const double fraction : {0.0, 0.3, 1.0}) {
        const CartesianVector in_body = robot.axis_point(link, fraction);
        const CartesianVector force = 10.0 * map.axes * CartesianVector::LinSpaced(map.axes.cols(), 1.0, 2.0);
        const PlatformVector expected = platform_wrench(robot.contact_jacobian(k, link, in_body), force);
        const CartesianVector in_axes = map.axes.transpose() * force;
        compare(wrenches, PlatformVector((map.at_joint + fraction * map.along) * in_axes), expected);
        compare(points, map.point(fraction), robot.point_on_body(k, link, in_body));
      }
    }
  }
}

TEST_P(LinkContactLaws, ThereIsNoMapOfThePlatformOrOfNoBody) {
  const Kinematics k = kinematics_at(robot.home_pose(), PlatformVector::Zero(n));
  EXPECT_FALSE(link_contact_map(robot, k, BodyId::platform()).valid);
  EXPECT_FALSE(link_contact_map(robot, k, BodyId::from_index(robot.body_count())).valid);
  EXPECT_FALSE(link_contact_map(robot, Kinematics(), BodyId::link1(0)).valid);
}

/// The point of a link's surface that `force`, in its axes, pushes, in the frame of the body.
CartesianVector surface_point(const Mechanism& robot, const Kinematics& k, BodyId link,
                              const LinkContactMap& map, double fraction, const CartesianVector& force) {
  const CartesianVector on_axis = robot.axis_point(link, fraction);
  CartesianVector across = force;
  across[0] = 0.0;
  const CartesianVector in_base = -map.radius / across.norm() * map.axes * across;
  CartesianVector point = on_axis;
  for (int i = 0; i < on_axis.size(); ++i) {
    const CartesianVector axis =
        robot.point_on_body(k, link, CartesianVector(on_axis + CartesianVector::Unit(on_axis.size(), i))) -
        robot.point_on_body(k, link, on_axis);
    point[i] += axis.dot(in_base);
  }
  return point;
}

TEST_P(LinkContactLaws, FrictionLeansAgainstTheVelocityOfTheTouchedPointAlongTheLink) {
  constexpr double leaning = 0.15, object_speed = 0.7;
  Residual means("of the mean lean", 1e-9);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    for (int i = 1; i < robot.body_count(); ++i) {
      const BodyId link = BodyId::from_index(i);
      const LinkContactMap map = link_contact_map(robot, k, link);
      const CartesianVector force = CartesianVector::LinSpaced(map.axes.cols(), 1.0, -20.0 + 5.0 * i);
      const CartesianVector point = surface_point(robot, k, link, map, 0.3, force);
      const CartesianVector velocity = robot.contact_jacobian(k, link, point).translation * state.velocity;
      const double sliding = map.axes.col(0).dot(velocity);
      const Lean lean = lean_by_friction(map, state.velocity, 0.3, force, leaning, object_speed);
      const double expected =
          -std::erf(sliding / (std::sqrt(2.0) * object_speed)) * leaning * std::sqrt(2.0 / std::numbers::pi);
      compare(means, Eigen::VectorXd::Constant(1, lean.mean), Eigen::VectorXd::Constant(1, expected));
      EXPECT_NEAR(lean.mean * lean.mean + lean.deviation * lean.deviation, leaning * leaning, 1e-12)
          << "the mean square is that of all leans, whatever is known of the sign";
    }
  }
}

TEST_P(LinkContactLaws, OfALinkAtRestFrictionMayLeanEitherWay) {
  const Kinematics k = kinematics_at(robot.home_pose(), PlatformVector::Zero(n));
  const LinkContactMap map = link_contact_map(robot, k, BodyId::link1(0));
  const CartesianVector force = CartesianVector::Ones(map.axes.cols());
  const Lean lean = lean_by_friction(map, PlatformVector::Zero(n), 0.5, force, 0.15, 0.2);
  EXPECT_EQ(lean.mean, 0.0);
  EXPECT_EQ(lean.deviation, 0.15);
  EXPECT_EQ(lean_by_friction(map, PlatformVector::Ones(n), 0.5, force, 0.0, 0.2).deviation, 0.0);
  EXPECT_EQ(lean_by_friction(LinkContactMap(), PlatformVector::Ones(n), 0.5, force, 0.15, 0.2).mean, 0.0);
}

PlatformMatrix noise(double force, double moment) {
  return PlatformVector{{force * force, force * force, moment * moment}}.asDiagonal();
}

class LinkPushes : public BothGeometries {
 protected:
  LinkContactMap map_of(const PoseAndVelocity& motion, BodyId link) const {
    return link_contact_map(robot, kinematics_at(motion.pose, motion.velocity), link);
  }
  static PlatformVector push(const LinkContactMap& map, double fraction, const Eigen::Vector2d& force) {
    return (map.at_joint + fraction * map.along) * CartesianVector(force);
  }
  double elbow(const PoseAndVelocity& motion, int leg) const {
    return kinematics_at(motion.pose, motion.velocity).joints.passive[leg];
  }
};
FLINCH_FOR_BOTH_GEOMETRIES(LinkPushes);

// The second formulation: F_n = n f and F_e = e f of the platform's force,
//   f_y = F_n + F_e tan qp,   l = F_n / f_y.
TEST_P(LinkPushes, OnASecondLinkAreThoseOfTheElbowsTangent) {
  Residual fraction("of the fraction", 1e-9);
  Residual force("of the force [N]", 1e-9);
  Residual formula("of F_n + F_e tan qp [N]", 1e-8);
  for (const auto& motion : motions) {
    for (int leg = 0; leg < 3; ++leg) {
      const double qp = elbow(motion, leg);
      if (std::abs(1.0 / std::tan(qp)) < 0.1) continue;
      const LinkContactMap map = map_of(motion, BodyId::link2(leg));
      for (const double l : {0.1, 0.5, 0.9}) {
        const PlatformVector wrench = push(map, l, {0.0, -37.0});
        const LinkPush found = link_push(map, wrench, noise(0.02, 0.002), 0.1);
        ASSERT_TRUE(found.valid && found.identifiable);
        fraction.add(found.fraction - l);
        force.add(found.force + 37.0);
        const Eigen::Vector2d f = wrench.head<2>();
        formula.add(f.dot(map.axes.col(1)) + f.dot(map.axes.col(0)) * std::tan(qp) - found.force);
        EXPECT_LT(found.residual, 1e-12);
      }
    }
  }
}

// Normalised squared errors of 1000 pushes with noise as stated: their mean is chi-square with 2000 degrees
// of freedom, over 1000.
TEST_P(LinkPushes, HaveErrorsAsLargeAsTheirCovarianceSays) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double sum = 0.0;
  double residuals = 0.0;
  int count = 0;
  for (int i = 0; count < 1000; ++i) {
    const auto& motion = motions[static_cast<std::size_t>(i) % motions.size()];
    const LinkContactMap map = map_of(motion, BodyId::link2(i % 3));
    const double l = uniform(generator);
    const double f = 20.0 + 60.0 * uniform(generator);
    PlatformVector wrench = push(map, l, {0.0, f});
    wrench += PlatformVector{{0.5 * normal(generator), 0.5 * normal(generator), 0.05 * normal(generator)}};
    const LinkPush found = link_push(map, wrench, noise(0.5, 0.05), 0.03);
    if (!found.identifiable) continue;
    ++count;
    const Eigen::Vector2d error(found.fraction - l, found.force - f);
    sum += error.dot(found.covariance.llt().solve(error));
    residuals += found.residual;
  }
  const double mean = sum / count;
  RecordProperty("normalised squared error", std::to_string(mean));
  std::printf("  normalised squared error %.3f of 2, residual %.3f of 1\n", mean, residuals / count);
  const double deviation =
      std::sqrt(2.0 * 2.0 / count);  // of the mean of chi-square with two degrees of freedom
  EXPECT_NEAR(mean, 2.0, 1.96 * deviation);
  EXPECT_NEAR(residuals / count, 1.0, 1.96 * std::sqrt(2.0 / count));
}

TEST_P(LinkPushes, OnAFirstLinkTellATorqueAndNoPlace) {
  for (const auto& motion : motions) {
    const LinkContactMap map = map_of(motion, BodyId::link1(1));
    const LinkPush found = link_push(map, push(map, 0.8, {0.0, 30.0}), noise(0.5, 0.05), 0.1);
    ASSERT_TRUE(found.valid);
    EXPECT_FALSE(found.identifiable);
    EXPECT_EQ(found.fraction, 0.5);
    EXPECT_NEAR(found.force * found.fraction, 30.0 * 0.8, 1e-9);
    EXPECT_TRUE(found.covariance.allFinite());
  }
}

// Turning the platform at home changes an elbow; where it is square, l and f_y appear only as a product.
TEST_P(LinkPushes, AreNotIdentifiableAtAnElbowOfNinetyDegrees) {
  PoseAndVelocity motion{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double low = -0.6, high = 0.3;  // y of the platform [m], between which the elbow of leg 1 passes 90 degrees
  const auto too_wide = [&](double x) {
    motion.pose = Eigen::Vector3d(x, 0.0, 0.0);
    return elbow(motion, 0) > std::numbers::pi / 2;
  };
  if (too_wide(low) == too_wide(high)) GTEST_FAIL() << "no such pose between";
  const bool wide_at_low = too_wide(low);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (too_wide(middle) == wide_at_low ? low : high) = middle;
  }
  motion.pose = Eigen::Vector3d(low, 0.0, 0.0);
  ASSERT_NEAR(elbow(motion, 0), std::numbers::pi / 2, 1e-9);
  const LinkContactMap map = map_of(motion, BodyId::link2(0));
  const LinkPush found = link_push(map, push(map, 0.3, {0.0, 50.0}), noise(0.5, 0.05), 0.1);
  ASSERT_TRUE(found.valid);
  EXPECT_FALSE(found.identifiable);
  EXPECT_NEAR(found.force * found.fraction, 15.0, 1e-6);
  EXPECT_NEAR(found.covariance(0, 0), 1.0 / 12.0, 1e-15);
}

TEST_P(LinkPushes, OfUnusableInputAreNotValid) {
  const LinkContactMap map = map_of(motions[0], BodyId::link2(0));
  const PlatformVector wrench = push(map, 0.5, {0.0, 20.0});
  EXPECT_FALSE(link_push(LinkContactMap(), wrench, noise(1.0, 0.1), 0.1).valid);
  EXPECT_FALSE(link_push(map, PlatformVector::Constant(3, nan), noise(1.0, 0.1), 0.1).valid);
  EXPECT_FALSE(link_push(map, PlatformVector::Zero(2), noise(1.0, 0.1), 0.1).valid);
  EXPECT_FALSE(link_push(map, wrench, noise(0.0, 0.0), 0.1).valid);
  const LinkPush nothing = link_push(map, PlatformVector::Zero(3), noise(1.0, 0.1), 0.1);
  EXPECT_TRUE(nothing.valid);
  EXPECT_FALSE(nothing.identifiable);
  EXPECT_TRUE(nothing.covariance.allFinite());
}

TEST_P(LinkPushes, ThatLeanAsIsKnownAreFoundExactly) {
  for (const PoseAndVelocity& motion : motions) {
    for (int leg = 0; leg < 3; ++leg) {
      const LinkContactMap map = map_of(motion, BodyId::link2(leg));
      for (const double across : {-40.0, 40.0}) {
        const double lean = 0.2;
        const PlatformVector wrench = push(map, 0.7, {lean * std::abs(across), across});
        const LinkPush found = link_push(map, wrench, noise(0.1, 0.01), 0.5, lean);
        if (!found.identifiable) continue;
        EXPECT_NEAR(found.fraction, 0.7, 1e-6);
        EXPECT_NEAR(found.force, across, 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace flinch::test
