#include "systems/laws/impedance_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/random.h"
#include "systems/framework/runge_kutta.h"
#include "systems/framework/simulator.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

ImpedanceSettings rig_impedance() { return complete({}, ConfigurationSpace::Kind::planar_pose); }

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d any(RandomGenerator& random, const Eigen::Vector3d& bound) {
  return {random.uniform(-bound[0], bound[0]), random.uniform(-bound[1], bound[1]),
          random.uniform(-bound[2], bound[2])};
}

PlatformReference rest(const PlatformVector& pose) {
  const PlatformVector zero = PlatformVector::Zero(3);
  return {true, true, pose, zero, zero};
}

struct Law {
  explicit Law(const ImpedanceSettings& settings = rig_impedance(),
               RigFriction friction = RigFriction::test_rig)
      : robot(test::planar_rig(friction)),
        block(builder.add<ImpedanceController>("impedance", robot, settings)),
        reference(builder.export_input("reference", block.reference)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        dynamics(builder.export_input("dynamics", block.dynamics)) {}

  const TorqueCommand& at(const test::Posture& posture, const PlatformReference& desired) {
    ticking.set(reference, desired);
    ticking.set(kinematics, posture.kinematics);
    ticking.set(dynamics, posture.dynamics);
    ticking.tick();
    return ticking.get(block.torque);
  }

  std::shared_ptr<const PlanarRrr> robot;
  DiagramBuilder builder;
  ImpedanceController& block;
  InputPort<PlatformReference> reference;
  InputPort<Kinematics> kinematics;
  InputPort<Dynamics> dynamics;
  test::Ticking ticking{builder};
};

// ---------------------------------------------------------------- the closed loop, by the plant's own
// equations

/// M_x dde + D_d de + K_d e = -F_ext at random motions and wrenches, with friction: [SafePR] (10).
TEST(ImpedanceController, MakesTheRobotAMassSpringDamper) {
  RandomGenerator random(11);
  Law law;
  const PlatformMatrix K_d = rig_impedance().stiffness.asDiagonal();
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d pose = any(random, {0.15, 0.15, 0.3}), velocity = any(random, {1.0, 1.0, 2.0});
    const Eigen::Vector3d F_ext = any(random, {100.0, 100.0, 5.0});
    const test::Posture posture(*law.robot, pose, velocity);
    const PlatformReference desired{true, false, pose + any(random, {0.05, 0.05, 0.1}),
                                    any(random, {1.0, 1.0, 2.0}), any(random, {10.0, 10.0, 40.0})};
    const TorqueCommand& torque = law.at(posture, desired);
    ASSERT_TRUE(torque.valid);

    const auto ddx = law.robot->acceleration(pose, velocity, Eigen::Vector3d(torque.torque), F_ext);
    ASSERT_TRUE(ddx.has_value());
    const PlatformMatrix& M_x = posture.dynamics.M_x;
    const PlatformMatrix D_d = impedance_damping(M_x, K_d, PlatformVector::Ones(3)).D;
    const PlatformVector e = desired.pose - pose, de = desired.velocity - velocity,
                         dde = desired.acceleration - *ddx;
    ASSERT_LT((M_x * dde + D_d * de + K_d * e + F_ext).norm(), 1e-9) << trial;
  }
}

TEST(ImpedanceController, LeavesFrictionToTheSpringWhenAskedTo) {
  ImpedanceSettings settings = rig_impedance();
  settings.compensate_friction = false;
  Law with, without(settings);
  const test::Posture posture(*with.robot, Eigen::Vector3d(0.05, 0.02, 0.1), Eigen::Vector3d(0.3, -0.4, 0.5));
  const PlatformReference desired = rest(Eigen::Vector3d::Zero());
  const JointVector difference = with.at(posture, desired).torque - without.at(posture, desired).torque;
  const JointVector friction = posture.kinematics.J_x_qa.transpose() * posture.dynamics.F_fr_x;
  EXPECT_LT((difference - friction).norm(), 1e-12);
  EXPECT_GT(friction.norm(), 0.5);
}

TEST(ImpedanceController, TurnsTheShorterWayRound) {
  Law law;
  const test::Posture posture(*law.robot);
  const double pi = std::acos(-1.0);
  law.at(posture, rest(Eigen::Vector3d(0.0, 0.0, 2.0 * pi - 0.1)));
  EXPECT_NEAR(law.ticking.get(law.block.wrench).error[2], -0.1, 1e-12);
}

/// A soft orientation makes the factorisation indefinite; the other design takes over.
TEST(ImpedanceController, FallsBackToADampingThatIsPositiveDefinite) {
  ImpedanceSettings settings = rig_impedance();
  settings.stiffness[2] = 0.01;
  Law stiff, soft(settings);
  RandomGenerator random(5);
  int fallbacks = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d pose = any(random, {0.2, 0.2, 0.3});
    const test::Posture posture(*soft.robot, pose);
    stiff.at(posture, rest(pose));
    EXPECT_EQ(stiff.ticking.get(stiff.block.wrench).damping, DampingDesign::factorisation);
    EXPECT_TRUE(soft.at(posture, rest(pose)).valid);
    fallbacks += soft.ticking.get(soft.block.wrench).damping == DampingDesign::generalised_eigenvalue ? 1 : 0;
  }
  EXPECT_GT(fallbacks, 0);
}

// ---------------------------------------------------------------- the closed loop in time

/// The robot without friction under impedance control in continuous time, pushed by a constant wrench.
class PushedPlant final : public System {
  using Motion = Eigen::Matrix<double, 6, 1>;
  State<Motion> motion_;

 public:
  PushedPlant(std::shared_ptr<const PlanarRrr> robot, Eigen::Vector3d pose, Eigen::Vector3d wrench)
      : motion_(state<Motion>("motion", (Motion() << pose, Eigen::Vector3d::Zero()).finished())),
        robot_(std::move(robot)),
        wrench_(std::move(wrench)) {
    platform = output<&PushedPlant::show>("platform", motion_, clock);
    derivative<&PushedPlant::rates>(motion_, motion_, torque);
  }
  InputPort<TorqueCommand> torque = input<TorqueCommand>("torque");
  OutputPort<PlatformMotion> platform;

 private:
  PlatformMotion show(const Motion& now, Time time) const {
    return {time, PlatformMotion::Status::valid, now.head<3>(), now.tail<3>()};
  }
  Motion rates(const Motion& now, const TorqueCommand& command) const {
    const auto ddx =
        robot_->acceleration(now.head<3>(), now.tail<3>(), Eigen::Vector3d(command.torque), wrench_);
    return (Motion() << now.tail<3>(), ddx.value_or(Eigen::Vector3d::Constant(nan))).finished();
  }
  std::shared_ptr<const PlanarRrr> robot_;
  Eigen::Vector3d wrench_;
};

struct Loop {
  Loop(const ImpedanceSettings& settings, const Eigen::Vector3d& start, const Eigen::Vector3d& wrench) {
    const auto robot = test::planar_rig();
    DiagramBuilder builder("loop");
    auto& plant = builder.add<PushedPlant>("plant", robot, start, wrench);
    auto& model = builder.add<RobotModel>("model", robot);
    auto& law = builder.add<ImpedanceController>("impedance", robot, settings);
    auto& home = builder.add<Constant<PlatformReference>>("home", rest(Eigen::Vector3d::Zero()));
    builder.connect(plant.platform, model.platform);
    builder.connect(model.kinematics, law.kinematics);
    builder.connect(model.dynamics, law.dynamics);
    builder.connect(home.value, law.reference);
    builder.connect(law.torque, plant.torque);
    platform = plant.platform;
    diagram = builder.build();
  }

  /// Where the platform is from now on, every millisecond.
  template <class See>
  void run(Time end, See see) {
    Context context = diagram->make_context();
    Simulator simulator(*diagram, std::make_unique<RungeKutta>(2));
    while (context.time() < end) {
      diagram->evaluate(context);
      see(to_seconds(context.time()), context.get(platform).pose);
      simulator.step(context);
    }
  }

  OutputPort<PlatformMotion> platform;
  std::unique_ptr<Diagram> diagram;
};

class ImpedanceOfStiffness : public testing::TestWithParam<double> {};

/// The stiffness set of [ICRA23] Fig. 5a: the platform gives way by F / k.
INSTANTIATE_TEST_SUITE_P(ImpedanceController, ImpedanceOfStiffness,
                         testing::Values(2000.0, 1000.0, 500.0, 250.0, 100.0));

TEST_P(ImpedanceOfStiffness, GivesWayByForceOverStiffness) {
  const double k = GetParam();
  const ImpedanceSettings settings{.stiffness = Eigen::Vector3d(k, k, 85.0),
                                   .damping_ratio = Eigen::Vector3d::Ones()};
  const Eigen::Vector3d wrench(6.0, -4.0, 0.5);
  PlatformVector last;
  Loop(settings, Eigen::Vector3d::Zero(), wrench).run(5s, [&](double, const PlatformVector& pose) {
    last = pose;
  });
  EXPECT_NEAR(last[0], 6.0 / k, 1e-8);
  EXPECT_NEAR(last[1], -4.0 / k, 1e-8);
  EXPECT_NEAR(last[2], 0.5 / 85.0, 1e-8);
}

/// At home the nominal rig has a diagonal M_x, so that small errors decay as (1 + w t) exp(-w t), w^2 = k /
/// m.
TEST(ImpedanceController, DecaysAsACriticallyDampedOscillator) {
  const Eigen::Vector3d start(1e-6, -2e-6, 3e-6);
  const test::Posture home(*test::planar_rig());
  const PlatformVector w = rig_impedance().stiffness.cwiseQuotient(home.dynamics.M_x.diagonal()).cwiseSqrt();
  double largest = 0.0;
  Loop(rig_impedance(), start, Eigen::Vector3d::Zero()).run(500ms, [&](double t, const PlatformVector& pose) {
    const Eigen::Array3d wt = t * Eigen::Array3d(w);
    const Eigen::Vector3d expected = start.array() * (1.0 + wt) * (-wt).exp();
    largest = std::max(
        largest, (pose - PlatformVector(expected)).cwiseAbs().cwiseQuotient(start.cwiseAbs()).maxCoeff());
  });
  EXPECT_LT(largest, 1e-4);
}

/// With damping ratios other than one: the linear oscillator's overshoot exp(-pi xi / sqrt(1 - xi^2)).
TEST(ImpedanceController, OvershootsAsItsDampingRatioSays) {
  ImpedanceSettings settings = rig_impedance();
  settings.damping_ratio = PlatformVector::Constant(3, 0.5);
  double lowest = 0.0;
  Loop(settings, Eigen::Vector3d(1e-6, 0, 0), Eigen::Vector3d::Zero())
      .run(500ms, [&](double, const PlatformVector& pose) { lowest = std::min(lowest, pose[0]); });
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(-lowest / 1e-6, std::exp(-pi * 0.5 / std::sqrt(0.75)), 1e-3);
}

// ---------------------------------------------------------------- bad input

TEST(ImpedanceController, IsNotValidWhereItsInputsAreNot) {
  Law law;
  const test::Posture good(*law.robot);
  const PlatformReference desired = rest(Eigen::Vector3d::Zero());
  test::Posture no_kinematics = good, no_dynamics = good;
  no_kinematics.kinematics.valid = false;
  no_dynamics.dynamics.valid = false;
  PlatformReference no_reference = desired, short_reference = desired;
  no_reference.valid = false;
  short_reference.velocity = Eigen::Vector2d::Zero();
  EXPECT_TRUE(law.at(good, desired).valid);
  EXPECT_FALSE(law.at(no_kinematics, desired).valid);
  EXPECT_FALSE(law.at(no_dynamics, desired).valid);
  EXPECT_FALSE(law.at(good, no_reference).valid);
  EXPECT_FALSE(law.at(good, short_reference).valid);
  EXPECT_EQ(law.ticking.get(law.block.torque).torque, JointVector::Zero(3));
}

TEST(ImpedanceController, IsNotValidOnNumbersThatAreNone) {
  Law law;
  const test::Posture good(*law.robot);
  for (int i = 0; i < 3; ++i) {
    PlatformReference desired[3] = {rest(Eigen::Vector3d::Zero()), rest(Eigen::Vector3d::Zero()),
                                    rest(Eigen::Vector3d::Zero())};
    desired[0].pose[i] = desired[1].velocity[i] = desired[2].acceleration[i] = nan;
    for (const PlatformReference& bad : desired) {
      EXPECT_FALSE(law.at(good, bad).valid);
      EXPECT_TRUE(law.ticking.get(law.block.torque).torque.allFinite());
    }
    test::Posture posture = good;
    posture.dynamics.M_x(i, i) = nan;
    EXPECT_FALSE(law.at(posture, rest(Eigen::Vector3d::Zero())).valid);
  }
}

TEST(ImpedanceController, NeverAllocates) {
  ImpedanceSettings soft = rig_impedance();
  soft.stiffness[2] = 0.01;
  for (const ImpedanceSettings& settings : {rig_impedance(), soft}) {
    Law law(settings);
    const test::Posture posture(*law.robot, Eigen::Vector3d(0.19, 0.15, 0.2), Eigen::Vector3d(1.0, 1.0, 1.0));
    const PlatformReference desired = rest(Eigen::Vector3d::Zero());
    law.at(posture, desired);
    const test::AllocationCounter counter;
    law.at(posture, desired);
    EXPECT_EQ(counter.count(), 0);
  }
}

TEST(ImpedanceController, IsStiffAndCriticallyDampedWhereNothingElseIsSaid) {
  EXPECT_EQ(rig_impedance().stiffness, Eigen::Vector3d(2000.0, 2000.0, 85.0));
  EXPECT_EQ(rig_impedance().damping_ratio, Eigen::Vector3d::Ones());
  const ImpedanceSettings in_space = complete({}, ConfigurationSpace::Kind::spatial_pose);
  EXPECT_EQ(in_space.stiffness, (PlatformVector{{2000.0, 2000.0, 2000.0, 85.0, 85.0, 85.0}}));
}

TEST(ImpedanceController, RefusesSettingsThatDoNotFit) {
  const auto robot = test::planar_rig();
  EXPECT_THROW(ImpedanceController(robot, {.stiffness = PlatformVector::Ones(2), .damping_ratio = {}}),
               SetupError);
  ImpedanceSettings settings = rig_impedance();
  settings.stiffness[0] = -1.0;
  EXPECT_THROW(ImpedanceController(robot, settings), SetupError);
  settings = rig_impedance();
  settings.damping_ratio[2] = 0.0;
  EXPECT_THROW(ImpedanceController(robot, settings), SetupError);
  settings.damping_ratio[2] = nan;
  EXPECT_THROW(ImpedanceController(robot, settings), SetupError);
}

}  // namespace
}  // namespace flinch
