#include "systems/estimators/momentum_sample.h"

#include <gtest/gtest.h>

#include <limits>

#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A complete set of inputs.
struct Inputs {
  Inputs() {
    const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::simulation));
    platform = {5ms, PlatformMotion::Status::valid, PlatformVector{{0.05, -0.02, 0.1}},
                PlatformVector{{0.8, 0.3, -1.0}}};
    robot.kinematics(platform.pose, platform.velocity, kinematics);
    robot.dynamics(kinematics, dynamics);
    torque = {5ms, true, JointVector{{3.0, -2.0, 1.0}}};
  }
  MomentumSample sample() const { return momentum_sample(platform, kinematics, dynamics, torque); }

  PlatformMotion platform;
  Kinematics kinematics;
  Dynamics dynamics;
  DriveTorque torque;
};

TEST(MomentumSample, HoldsMomentumAndBeta) {
  const Inputs inputs;
  const MomentumSample sample = inputs.sample();
  const auto& [M, C, g, F_fr, valid] = inputs.dynamics;
  const PlatformVector& dx = inputs.platform.velocity;
  ASSERT_TRUE(sample.valid);
  EXPECT_EQ(sample.acquired, 5ms);
  EXPECT_LT((sample.p - M * dx).norm(), 1e-14);
  EXPECT_LT((sample.beta - (g + F_fr - C.transpose() * dx)).norm(), 1e-13);
  EXPECT_GT((sample.beta - (g + F_fr - C * dx)).norm(), 0.1);  // it matters which
}

// d/dt (M dx) = F_a + F_ext - beta is the equation of motion written differently: compare with M ddx + C dx +
// ... .
TEST(MomentumSample, BetaTurnsTheEquationOfMotionIntoOneOfMomentum) {
  const PlanarRrr robot(rig_robot(RigGeometry::individual, RigFriction::simulation));
  const Inputs inputs;
  const Eigen::Vector3d ddx(3.0, -5.0, 8.0);
  const Eigen::Vector3d x = inputs.platform.pose;
  const Eigen::Vector3d dx = inputs.platform.velocity;
  const auto momentum_at = [&](double t) -> PlatformVector {
    Kinematics kinematics;
    Dynamics dynamics;
    robot.kinematics(PlatformVector(x + t * dx + 0.5 * t * t * ddx), PlatformVector(dx + t * ddx),
                     kinematics);
    robot.dynamics(kinematics, dynamics);
    return dynamics.M_x * kinematics.velocity;
  };
  constexpr double h = 1e-5;
  const PlatformVector dp = (momentum_at(h) - momentum_at(-h)) / (2.0 * h);
  const auto& [M, C, g, F_fr, valid] = inputs.dynamics;
  const PlatformVector total = M * ddx + C * dx + g + F_fr;  // F_a + F_ext
  EXPECT_LT((dp - (total - inputs.sample().beta)).norm(), 1e-7);
}

TEST(MomentumSample, IsNotValidUnlessAllOfItIs) {
  const Inputs good;
  Inputs bad = good;
  bad.platform.status = PlatformMotion::Status::implausible;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.kinematics.valid = false;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.dynamics.valid = false;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.torque.valid = false;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.torque.torque.resize(2);
  EXPECT_FALSE(bad.sample().valid);
}

TEST(MomentumSample, IsNotValidUnlessAllOfItIsFinite) {
  const Inputs good;
  Inputs bad = good;
  bad.torque.torque[2] = nan;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.dynamics.M_x(0, 0) = nan;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.dynamics.F_fr_x[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.kinematics.velocity[0] = nan;
  EXPECT_FALSE(bad.sample().valid);
  bad = good;
  bad.kinematics.J_qa_x(1, 1) = nan;
  EXPECT_FALSE(bad.sample().valid);
}

// One coordinate: J = 2 then 4, beta = 1 then 3, torque = 10 then 20.
TEST(MomentumSample, AveragesTheKnownWrenchAsTheTorqueActed) {
  const auto scalar = [](double value) { return PlatformMatrix::Constant(1, 1, value); };
  const auto number = [](double value) { return PlatformVector::Constant(1, value); };
  const MomentumSample previous{true, 0ms, number(0.0), number(1.0), scalar(2.0), number(10.0)};
  const MomentumSample now{true, 1ms, number(0.0), number(3.0), scalar(4.0), number(20.0)};
  EXPECT_EQ(mean_known_wrench(previous, now, TorqueTiming::sampled)[0],
            0.5 * (2.0 * 10.0 + 4.0 * 20.0) - 2.0);
  EXPECT_EQ(mean_known_wrench(previous, now, TorqueTiming::held)[0], 0.5 * (2.0 * 20.0 + 4.0 * 20.0) - 2.0);
}

}  // namespace
}  // namespace flinch
