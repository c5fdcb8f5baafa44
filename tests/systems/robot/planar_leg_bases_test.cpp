#include "systems/robot/planar_leg_bases.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <vector>

#include "systems/robot/contact_jacobian.h"
#include "systems/robot/leg_bases.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array<double, 3> first_moments = {1.1, 0.9, 1.3};

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
}

/// The robot in a random state, under random torques and a force on one of its bodies.
struct RandomState {
  std::shared_ptr<const PlanarRrr> robot;
  Vector3d pose, velocity, torque;
  ForceOnBody force;
  Kinematics at;
  Vector3d acceleration;

  RandomState(const std::shared_ptr<const PlanarRrr>& of, std::mt19937_64& random, int body) : robot(of) {
    const auto draw = [&](double limit) {
      return std::uniform_real_distribution<double>(-limit, limit)(random);
    };
    pose = {draw(0.15), draw(0.15), draw(0.3)};
    velocity = {draw(1.0), draw(1.0), draw(2.0)};
    torque = {draw(20.0), draw(20.0), draw(20.0)};
    robot->kinematics(pose, velocity, at);
    const BodyId id = BodyId::from_index(body);
    const CartesianVector point = robot->axis_point(id, 0.5 + draw(0.4));
    force = {body, robot->point_on_body(at, id, point), Vector2d(draw(50.0), draw(50.0))};
    const PlatformVector wrench =
        platform_wrench(robot->contact_jacobian(at, id, point), force.force_in_base);
    acceleration = *robot->acceleration(pose, velocity, torque, wrench.head<3>());
  }
};

// ---------------------------------------------------------------- laws

/// Linear momentum of the platform and of all legs, from the velocities of their joints.
Vector2d linear_momentum(const PlanarRrr& robot, const Vector3d& pose, const Vector3d& velocity) {
  const PlanarMotion motion = robot.motion(pose, velocity);
  Vector2d sum = robot.parameters().platform_mass * velocity.head<2>();
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = robot.parameters().legs[i];
    const PlanarLegMotion& now = motion.legs[i];
    const Vector2d elbow = leg.link1_length * now.qa_rate * normal(now.leg.u1);
    const Vector2d second = leg.link2_length * now.theta2_rate * normal(now.leg.u2);
    sum += first_moments[i] / leg.link1_length * elbow +
           leg.inertia.p3 / leg.link1_length / leg.link2_length * second;
  }
  return sum;
}

TEST(PlanarLegBases, BearWhatChangesTheMomentumOfTheWholeRobot) {
  const auto robot = rig();
  const PlanarLegBases bases(robot, first_moments);
  std::mt19937_64 random(7);
  for (int body = 0; body < 7; ++body) {
    for (int k = 0; k < 20; ++k) {
      const RandomState now(robot, random, body);
      BaseForces forces;
      bases.forces(now.at, now.acceleration, now.torque, {&now.force, 1}, forces);
      ASSERT_EQ(forces.size(), 6);
      const double h = 1e-6;
      const auto at = [&](double t) {
        return linear_momentum(*robot, now.pose + t * now.velocity + 0.5 * t * t * now.acceleration,
                               now.velocity + t * now.acceleration);
      };
      const Vector2d rate = (at(h) - at(-h)) / (2.0 * h);
      const Vector2d sum = forces.segment<2>(0) + forces.segment<2>(2) + forces.segment<2>(4) +
                           now.force.force_in_base.head<2>();
      EXPECT_LT((sum - rate).norm(), 1e-5 * (1.0 + rate.norm())) << body;
    }
  }
}

TEST(PlanarLegBases, MomentumChangesByWhatIsKnownByTheBaseForcesAndByWhatIsFelt) {
  const auto robot = rig();
  const PlanarLegBases bases(robot, first_moments);
  std::mt19937_64 random(8);
  for (int body = 0; body < 7; ++body) {
    for (int k = 0; k < 20; ++k) {
      const RandomState now(robot, random, body);
      BaseForces forces, p, s, before, after, unused;
      bases.forces(now.at, now.acceleration, now.torque, {&now.force, 1}, forces);
      bases.momentum(now.at, now.torque, p, s);
      const double h = 1e-6;
      const auto at = [&](double t, BaseForces& momentum) {
        Kinematics there;
        robot->kinematics(now.pose + t * now.velocity + 0.5 * t * t * now.acceleration,
                          now.velocity + t * now.acceleration, there);
        bases.momentum(there, now.torque, momentum, unused);
      };
      at(-h, before);
      at(h, after);
      BaseForces expected = s + forces;
      const BodyId id = BodyId::from_index(body);
      if (!id.is_platform()) {
        expected.segment<2>(2 * id.leg()) +=
            bases.felt(now.at, id, now.force.point_in_base, now.force.force_in_base);
      }
      const BaseForces rate = (after - before) / (2.0 * h);
      EXPECT_LT((rate - expected).norm(), 1e-5 * (1.0 + rate.norm())) << body;
    }
  }
}

TEST(PlanarLegBases, FeelWhatThePlatformDoesNotOfAForceOnALink) {
  const auto robot = rig();
  const PlanarLegBases bases(robot, first_moments);
  std::mt19937_64 random(9);
  for (int body = 1; body < 7; ++body) {
    const RandomState now(robot, random, body);
    const BodyId id = BodyId::from_index(body);
    // The point moves by Lambda J_c dx where the coupling joint moves by J_c dx.
    const LegPoints& leg = now.at.legs[static_cast<std::size_t>(id.leg())];
    const Vector2d arm = (leg.coupling_joint - now.pose.head<2>()).head<2>();
    Eigen::Matrix<double, 2, 3> J_c;
    J_c << Eigen::Matrix2d::Identity(), Vector2d(-arm.y(), arm.x());
    const Vector2d f = now.force.force_in_base.head<2>();
    const Vector2d passed_on =
        f - Vector2d(bases.felt(now.at, id, now.force.point_in_base, now.force.force_in_base));
    const CartesianVector point = robot->axis_point(id, 0.5);
    const CartesianVector middle = robot->point_on_body(now.at, id, point);
    const Vector2d of_middle = f - Vector2d(bases.felt(now.at, id, middle, now.force.force_in_base));
    const PlatformVector wrench =
        platform_wrench(robot->contact_jacobian(now.at, id, point), now.force.force_in_base);
    EXPECT_LT((J_c.transpose() * of_middle - wrench).norm(), 1e-10 * wrench.norm());
    EXPECT_TRUE(passed_on.allFinite());
  }
  const RandomState now(robot, random, 0);
  EXPECT_EQ(bases.felt(now.at, BodyId::platform(), now.force.point_in_base, now.force.force_in_base),
            CartesianVector(Vector2d::Zero()));
}

// ---------------------------------------------------------------- by hand

TEST(PlanarLegBases, BearNothingAtRestUnlessSomethingPushes) {
  const auto robot = std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
  const PlanarLegBases bases(robot, first_moments);
  Kinematics at;
  robot->kinematics(Vector3d::Zero(), Vector3d::Zero(), at);
  BaseForces forces;
  bases.forces(at, PlatformVector::Zero(3), JointVector::Zero(3), {}, forces);
  EXPECT_LT(forces.norm(), 1e-14);
  // A push towards its own base on the elbow of the first leg is borne by that base alone.
  const LegPoints& leg = at.legs[0];
  const CartesianVector along = (leg.passive_joint - leg.base_joint).normalized();
  const ForceOnBody push{BodyId::link1(0).index(), leg.passive_joint, -10.0 * along};
  bases.forces(at, PlatformVector::Zero(3), JointVector::Zero(3), {&push, 1}, forces);
  EXPECT_LT((forces.head<2>() - 10.0 * along.head<2>()).norm(), 1e-12);
  EXPECT_LT(forces.tail<4>().norm(), 1e-12);
}

}  // namespace
}  // namespace flinch
