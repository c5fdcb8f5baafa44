#include "systems/robot/parameter_variants.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

struct Instant {
  Kinematics at;
  PlatformVector acceleration;
};

Instant random_instant(const ParallelRobot& robot, RandomGenerator& random) {
  Instant now;
  const int n = robot.dof();
  PlatformVector away(n), velocity(n);
  now.acceleration.resize(n);
  for (int i = 0; i < n; ++i) {
    away[i] = random.uniform(-0.08, 0.08);
    velocity[i] = random.uniform(-1.0, 1.0);
    now.acceleration[i] = random.uniform(-10.0, 10.0);
  }
  robot.kinematics(robot.space().plus(robot.home_pose(), away), velocity, now.at);
  return now;
}

/// Columns of one leg and of the platform as they stand in the equations: in (qa, qp), with c and s of qp,
///   Y = [ddqa, ddqp, 2 c ddqa + c ddqp - s (2 dqa dqp + dqp^2); 0, ddqa + ddqp, c ddqa + s dqa^2].
Eigen::MatrixXd written_out(const Instant& now, double friction_velocity) {
  const Kinematics& k = now.at;
  Eigen::MatrixXd Y_x(3, 23);
  Y_x.setZero();
  for (int i = 0; i < 3; ++i) {
    Eigen::MatrixXd J(2, 3), dJ(2, 3);
    J << k.J_qa_x.row(i), k.J_qp_x.row(i);
    dJ << k.dJ_qa_x.row(i), k.dJ_qp_x.row(i);
    const Eigen::Vector2d dd = J * now.acceleration + dJ * k.velocity;
    const double da = k.rates.active[i], dp = k.rates.passive[i];
    const double c = std::cos(k.joints.passive[i]), s = std::sin(k.joints.passive[i]);
    Eigen::MatrixXd leg(2, 3);
    leg << dd[0], dd[1], 2.0 * c * dd[0] + c * dd[1] - s * (2.0 * da * dp + dp * dp), 0.0, dd[0] + dd[1],
        c * dd[0] + s * da * da;
    Y_x.block(0, 7 * i, 3, 3) = J.transpose() * leg;
    Y_x.col(7 * i + 3) = J.row(0).transpose() * da;
    Y_x.col(7 * i + 4) = J.row(0).transpose() * std::tanh(da / friction_velocity);
    Y_x.col(7 * i + 5) = J.row(1).transpose() * dp;
    Y_x.col(7 * i + 6) = J.row(1).transpose() * std::tanh(dp / friction_velocity);
  }
  Y_x(0, 21) = now.acceleration[0];
  Y_x(1, 21) = now.acceleration[1];
  Y_x(2, 22) = now.acceleration[2];
  return k.J_x_qa.transpose() * Y_x;
}

TEST(Regressor, OfThePlanarRobotIsThatOfItsWrittenEquations) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  const auto parameters = DynamicParameters::of(robot);
  const ParameterVariants variants(*parameters);
  ASSERT_EQ(variants.size(), 23U);
  RandomGenerator random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Instant now = random_instant(robot, random);
    const Eigen::MatrixXd got =
        variants.regressor(model_effort(robot, now.at, now.acceleration), now.at, now.acceleration);
    const Eigen::MatrixXd expected = written_out(now, robot.parameters().friction_velocity);
    EXPECT_LT((got - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff());
  }
}

/// The effort is linear in the parameters, so believed + Y (p - believed) is that of the robot with p.
template <class Robot>
void expect_linear(const Robot& robot) {
  const auto parameters = DynamicParameters::of(robot);
  const ParameterVariants variants(*parameters);
  RandomGenerator random(2);
  Eigen::VectorXd values = parameters->believed();
  for (std::size_t j = 0; j < parameters->list().size(); ++j) {
    const double reach = std::min(0.05 * parameters->list()[j].deviation, 0.02);
    values[static_cast<Eigen::Index>(j)] += random.uniform(0.0, reach);
  }
  const auto other = parameters->with(values);
  for (int trial = 0; trial < 20; ++trial) {
    const Instant now = random_instant(robot, random);
    const JointVector base = model_effort(robot, now.at, now.acceleration);
    const Eigen::VectorXd predicted =
        base + variants.regressor(base, now.at, now.acceleration) * (values - parameters->believed());
    const JointVector expected = model_effort(*other, now.at, now.acceleration);
    EXPECT_LT((predicted - expected).norm(), 1e-8 * (1.0 + expected.norm())) << robot.name();
  }
}

TEST(Regressor, MakesTheEffortOfEveryMechanismLinear) {
  expect_linear(PlanarRrr(rig_robot(RigGeometry::individual, RigFriction::test_rig)));
  expect_linear(Hexapod(hexapod_robot()));
}

TEST(Parameters, OfTheRobotItselfAreTheRobot) {
  const Hexapod robot(hexapod_robot());
  const auto parameters = DynamicParameters::of(robot);
  const auto same = parameters->with(parameters->believed());
  RandomGenerator random(3);
  const Instant now = random_instant(robot, random);
  EXPECT_LT(
      (model_effort(robot, now.at, now.acceleration) - model_effort(*same, now.at, now.acceleration)).norm(),
      1e-9);
  const auto told = parameters->in_file(parameters->believed());
  const auto mass =
      std::find_if(told.begin(), told.end(), [](const FileValue& v) { return v.name == "platform.mass_kg"; });
  ASSERT_NE(mass, told.end());
  EXPECT_EQ(mass->value, robot.parameters().platform.mass);
}

// The inertial columns of equal legs have one direction that no motion shows (all legs alike).
TEST(Regressor, OfEqualLegsDoesNotSeeOneDirection) {
  const PlanarRrr robot(rig_robot(RigGeometry::nominal, RigFriction::none));
  const auto parameters = DynamicParameters::of(robot);
  const ParameterVariants variants(*parameters);
  const double l1 = robot.parameters().legs[0].link1_length, l2 = robot.parameters().legs[0].link2_length;
  const double r = robot.parameters().coupling_radius;
  Eigen::VectorXd unseen = Eigen::VectorXd::Zero(23);
  for (int i = 0; i < 3; ++i) unseen.segment<3>(7 * i) << l1 * l1 + l2 * l2, l2 * l2, l1 * l2;
  unseen.tail<2>() << -3.0, -3.0 * r * r;
  RandomGenerator random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Instant now = random_instant(robot, random);
    const Eigen::MatrixXd Y =
        variants.regressor(model_effort(robot, now.at, now.acceleration), now.at, now.acceleration);
    EXPECT_LT((Y * unseen).norm(), 1e-7 * Y.norm());
  }
}

}  // namespace
}  // namespace flinch
