#include "plant/rig_dynamics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include "plant/sundials_integrator.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/runge_kutta.h"
#include "tests/plant/integrate_rig.h"
#include "tests/plant/moving_rig.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

const DriveAction coasting{
    .torque = JointVector::Zero(3), .current = JointVector::Zero(3), .enabled = true, .braked = false};

RigSettings rig(RigFriction friction = RigFriction::none) {
  RigSettings settings;
  settings.robot = test::individual_rig(friction);
  settings.link_material.reset();
  return settings;
}

RigSettings moving_rig(RigFriction friction = RigFriction::none) {
  RigSettings settings = rig(friction);
  settings.initial_velocity = PlatformVector{{0.6, -0.4, 1.0}};
  return settings;
}

/// The rig and the work done on it, integrated tick by tick.
class MovingRig {
  std::unique_ptr<const RigDynamics> dynamics_;

 public:
  explicit MovingRig(const RigSettings& settings, std::unique_ptr<Integrator> method = nullptr)
      : dynamics_(RigDynamics::make(settings)),
        dynamics(*dynamics_),
        equation(dynamics),
        y(equation.size(), 0.0),
        integrator_(method ? std::move(method) : std::make_unique<SundialsIntegrator>()) {
    equation.drives = coasting;
    const RigState start = dynamics.initial_state();
    std::copy_n(start.data(), start.size(), y.begin());
    integrator_->prepare(y.size());
  }

  bool tick() { return integrator_->advance(equation, 1e-3, y); }

  RigState state() const {
    return Eigen::Map<const Eigen::VectorXd>(y.data(), dynamics.initial_state().size());
  }
  Eigen::Vector3d pose() const { return state().head<3>(); }
  RigSnapshot now() const {
    RigSnapshot snapshot;
    dynamics.snapshot(state(), equation.drives, equation.applied_wrench, equation.step, 0.0, snapshot);
    return snapshot;
  }
  double kinetic_energy() const { return now().kinetic_energy; }
  /// Work of drives, applied wrench and contacts, less that lost to friction [J].
  double work() const {
    const auto works = std::span(y).last(test::RigEquation::works);
    return works[0] + works[1] + works[2] - works[3];
  }
  double contact_work() const { return y[y.size() - 2]; }

  const RigDynamics& dynamics;
  test::RigEquation equation;
  std::vector<double> y;

 private:
  std::unique_ptr<Integrator> integrator_;
};

// ---------------------------------------------------------------- energy

// Starts from which no leg stretches or folds within five seconds.
TEST(FreeMotion, KeepsItsEnergyForFiveSeconds) {
  for (const Eigen::Vector3d& start_velocity :
       {Eigen::Vector3d(-0.03, 0.13, 2.73), Eigen::Vector3d(-0.11, -0.06, 2.79),
        Eigen::Vector3d(0.06, -0.07, 2.95)}) {
    RigSettings settings = rig();
    settings.initial_velocity = start_velocity;
    MovingRig rig(settings);
    const double start = rig.kinetic_energy();
    double drift = 0.0;
    double travelled = 0.0;
    for (int k = 0; k < 5000; ++k) {
      ASSERT_TRUE(rig.tick());
      drift = std::max(drift, std::abs(rig.kinetic_energy() / start - 1.0));
      travelled += 1e-3 * rig.state().segment<2>(3).norm();
    }
    std::cout << "relative drift of the energy: " << drift << " over " << travelled << " m\n";
    EXPECT_LT(drift, 1e-10);
    EXPECT_GT(travelled, 0.7);
  }
}

TEST(DrivenMotion, GainsTheWorkOfDrivesWrenchAndContactsLessFriction) {
  RigSettings settings = moving_rig(RigFriction::test_rig);
  settings.obstacles = {test::fixed_post(0.32, 0.20)};
  settings.link_material = ContactMaterial{.stiffness = 5e4};
  const SundialsOptions tight{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12};
  MovingRig rig(settings, std::make_unique<SundialsIntegrator>(tight));
  const double start = rig.kinetic_energy();
  double imbalance = 0.0;
  int in_contact = 0;
  for (int k = 0; k < 1500; ++k) {
    const double t = 1e-3 * k;
    rig.equation.drives.torque.resize(3);
    rig.equation.drives.torque << 8.0 * std::sin(5.0 * t), 8.0 * std::cos(7.0 * t), -6.0 * std::sin(3.0 * t);
    rig.equation.applied_wrench << 10.0 * std::cos(4.0 * t), -5.0, 1.0;
    ASSERT_TRUE(rig.tick());
    ASSERT_TRUE(rig.now().reachable) << k;
    imbalance = std::max(imbalance, std::abs(rig.kinetic_energy() - start - rig.work()));
    if (rig.now().contacts.touch_count > 0) ++in_contact;
  }
  std::cout << "imbalance of the energy: " << imbalance << " J of " << rig.kinetic_energy() << " J, "
            << in_contact << " ms in contact\n";
  EXPECT_LT(imbalance, 1e-8);
  EXPECT_GT(in_contact, 50);
  EXPECT_LT(rig.contact_work(), -1e-3) << "contacts dissipate";
}

double spring_energy(const ContactForces& contacts, double stiffness) {
  double energy = 0.0;
  for (int i = 0; i < contacts.touch_count; ++i) {
    energy += 0.5 * stiffness * std::pow(contacts.touches[static_cast<std::size_t>(i)].depth, 2);
  }
  return energy;
}

TEST(ElasticPylon, ReturnsTheEnergyThatItTook) {
  RigSettings settings = moving_rig();
  const ContactMaterial elastic{.restitution = 1.0};
  settings.obstacles = {test::fixed_post(0.32, 0.20, elastic)};
  MovingRig rig(settings);
  const double start = rig.kinetic_energy();
  double drift = 0.0;
  double stored = 0.0;
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(rig.tick());
    const double spring = spring_energy(rig.now().contacts, elastic.stiffness);
    stored = std::max(stored, spring);
    drift = std::max(drift, std::abs((rig.kinetic_energy() + spring) / start - 1.0));
  }
  std::cout << "relative drift of the energy: " << drift << ", at most " << stored << " J in the pylon\n";
  EXPECT_LT(drift, 1e-7);
  EXPECT_GT(stored, 0.1 * start);
}

TEST(CompliantPylon, SharesItsEnergyWithTheRobot) {
  RigSettings settings = moving_rig();
  const ContactMaterial elastic{.restitution = 1.0};
  const CompliantMount pylon{.damping = 0.0};
  settings.obstacles = {test::compliant_post(0.32, 0.20, elastic, pylon)};
  MovingRig rig(settings);
  const double start = rig.kinetic_energy();
  double drift = 0.0;
  double in_pylon = 0.0;
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(rig.tick());
    const RigState state = rig.state();
    ASSERT_EQ(state.size(), 12);
    const double mount = 0.5 * pylon.stiffness * state.segment<3>(6).squaredNorm() +
                         0.5 * pylon.mass * state.segment<3>(9).squaredNorm();
    in_pylon = std::max(in_pylon, mount);
    const double spring = spring_energy(rig.now().contacts, elastic.stiffness);
    drift = std::max(drift, std::abs((rig.kinetic_energy() + spring + mount) / start - 1.0));
  }
  std::cout << "relative drift of the energy: " << drift << ", at most " << in_pylon
            << " J in the mounting\n";
  EXPECT_LT(drift, 1e-7);
  EXPECT_GT(in_pylon, 0.05 * start);
}

TEST(CompliantPylon, AloneIsADampedOscillator) {
  RigSettings settings = rig();
  const CompliantMount mount;
  settings.obstacles = {test::compliant_post(1.5, 0.0, {}, mount)};
  MovingRig moving(settings);
  moving.y[6] = 0.01;
  const double m = mount.mass;
  const double decay = mount.damping / (2.0 * m);
  const double omega = std::sqrt(mount.stiffness / m - decay * decay);
  for (int k = 1; k <= 300; ++k) {
    moving.tick();
    const double t = 1e-3 * k;
    const double expected =
        0.01 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    EXPECT_NEAR(moving.state()[6], expected, 1e-8);
    EXPECT_EQ(moving.state()[7], 0.0);
  }
}

// ---------------------------------------------------------------- accuracy

TEST(RigMotion, FollowsTinyFixedStepsInFreeMotionAndInContact) {
  for (const bool with_pylon : {false, true}) {
    RigSettings settings = moving_rig(RigFriction::simulation);
    if (with_pylon) settings.obstacles = {test::fixed_post(0.32, 0.20)};
    MovingRig rig(settings);
    MovingRig reference(settings, std::make_unique<RungeKutta>(100));
    double worst = 0.0;
    for (int k = 0; k < 400; ++k) {
      const Eigen::Vector3d torque(5.0 * std::sin(0.02 * k), -3.0, 4.0 * std::cos(0.03 * k));
      rig.equation.drives.torque = reference.equation.drives.torque = torque;
      rig.tick();
      reference.tick();
      worst = std::max(worst, (rig.pose() - reference.pose()).norm());
    }
    std::cout << (with_pylon ? "with" : "without") << " pylon, from tiny steps: " << worst << "\n";
    EXPECT_LT(worst, with_pylon ? 1e-7 : 1e-9);
  }
}

// ---------------------------------------------------------------- brakes, limits

TEST(Brakes, StopTheRobotAndHoldIt) {
  MovingRig rig(moving_rig());
  rig.equation.drives = DriveAction();
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(rig.tick());
  EXPECT_LT(rig.state().segment<3>(3).norm(), 1e-3);

  const Eigen::Vector3d before = rig.pose();
  rig.equation.applied_wrench << 40.0, 0.0, 0.0;
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(rig.tick());
  EXPECT_LT((rig.pose() - before).head<2>().norm(), 1e-3) << "it creeps by less than 1 cm/s under 40 N";
}

// ---------------------------------------------------------------- friction that sticks

RigSettings sticking(RigSettings settings, double stiffness) {
  settings.sticking.stiffness = JointVector::Constant(3, stiffness);
  return settings;
}

JointVector dry_friction(const Mechanism& robot) {
  JointVector efforts(robot.drives());
  for (int i = 0; i < robot.drives(); ++i) efforts[i] = robot.dry_friction(i).effort;
  return efforts;
}

/// How far the drives have gone in so many ticks under a share of their dry friction.
double gone(const RigSettings& settings, double share, int ticks) {
  test::MovingRig rig(settings);
  const JointVector start = rig.now.joints.active;
  rig.equation.drives.torque = share * dry_friction(*settings.robot);
  for (int k = 0; k < ticks; ++k) rig.tick();
  return settings.robot->drive_difference(rig.now.joints.active, start).lpNorm<Eigen::Infinity>();
}

TEST(StickingFriction, HoldsATorqueBelowItsLargestWithoutCreeping) {
  for (const double stiffness : {2000.0, 40'000.0}) {
    const RigSettings settings = sticking(rig(RigFriction::test_rig), stiffness);
    const double give = dry_friction(*settings.robot).maxCoeff() / stiffness;
    const double soon = gone(settings, 0.8, 4000), late = gone(settings, 0.8, 8000);
    EXPECT_LT(soon, 3.0 * give);
    EXPECT_LT(late - soon, 1e-3 * give) << "no creep";
  }
  const RigSettings rounded = rig(RigFriction::test_rig);
  EXPECT_GT(gone(rounded, 0.8, 2000), 0.005) << "which friction that is rounded does";
}

TEST(StickingFriction, LetsGoAboveItsLargest) {
  const RigSettings settings = sticking(rig(RigFriction::test_rig), 5000.0);
  EXPECT_GT(gone(settings, 1.2, 300), 50.0 * gone(settings, 0.8, 300));
}

TEST(StickingFriction, BrakesAMovingRobotAsTheModelsDoes) {
  const RigSettings rounded = moving_rig(RigFriction::test_rig);
  test::MovingRig with(sticking(rounded, 2000.0)), without(rounded);
  double before = with.now.kinetic_energy;
  const double start = before;
  for (int k = 0; k < 100; ++k) {
    with.tick(), without.tick();
    if (k < 5) continue;  // friction of both drives has built up
    EXPECT_LE(with.now.kinetic_energy, before) << k;
    before = with.now.kinetic_energy;
  }
  EXPECT_NEAR(with.now.kinetic_energy, without.now.kinetic_energy, 0.01 * start);
}

TEST(RigDynamics, StandsStillWhereALegWouldHaveToStretchBeyondItsReach) {
  const auto dynamics = RigDynamics::make(rig());
  const PlatformVector nothing = PlatformVector::Zero(3);
  RigState state = dynamics->initial_state();
  state.head<3>() << 2.0, 0.0, 0.0;
  state.segment<3>(3) << 1.0, 1.0, 1.0;
  RigState rates;
  dynamics->rates(state, coasting, nothing, dynamics->initial_step(), rates);
  EXPECT_EQ(rates, RigState::Zero(6));
  RigSnapshot snapshot;
  dynamics->snapshot(state, coasting, nothing, dynamics->initial_step(), 1e-3, snapshot);
  EXPECT_FALSE(snapshot.reachable);
}

TEST(RigDynamics, MovesAlikeWithAllPairsAndWithThoseThatCanTouch) {
  RigSettings settings = moving_rig();
  settings.obstacles = {test::fixed_post(0.2, 0.1), test::compliant_post(-0.05, 0.1)};
  settings.link_material = ContactMaterial{.stiffness = 5e4};
  const auto dynamics = RigDynamics::make(settings);
  const PlatformVector nothing = PlatformVector::Zero(3);
  const RigState state = dynamics->initial_state();
  RigStep step = dynamics->initial_step();
  RigState with_all;
  RigState with_some;
  dynamics->rates(state, coasting, nothing, step, with_all);
  RigSnapshot snapshot;
  dynamics->snapshot(state, coasting, nothing, step, 1e-3, snapshot);
  dynamics->next_step(state, 0.0, snapshot, dynamics->initial_step(), step);
  dynamics->rates(state, coasting, nothing, step, with_some);
  EXPECT_EQ(with_all, with_some);
  EXPECT_GT(snapshot.contacts.touch_count, 0);
  EXPECT_LT(step.search.candidates.count(), 7);
}

TEST(RigDynamics, RefusesImpossibleSettingsNamingThemAll) {
  RigSettings settings = rig();
  ObstacleForm form = test::post_form(0.0, 0.0, {.restitution = 1.5});
  form.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = -1.0};
  settings.obstacles = {std::make_shared<const CompliantObstacle>(form, CompliantMount{.mass = 0.0})};
  settings.link_material = ContactMaterial{.stiffness = 0.0};
  settings.brake.velocity = std::nan("");
  try {
    RigDynamics::make(settings);
    FAIL();
  } catch (const SetupError& error) {
    ASSERT_EQ(error.problems().size(), 5U);
    EXPECT_EQ(error.problems()[0], "post.radius is -1 m; it must be positive");
    EXPECT_EQ(error.problems()[2], "post.material.restitution is 1.5; it must be at most 1");
    EXPECT_EQ(error.problems()[4], "brake.velocity is nan rad/s; it must be positive");
  }
  settings = rig();
  settings.initial_pose = Eigen::Vector3d(3.0, 0.0, 0.0);
  EXPECT_THROW(RigDynamics::make(settings), SetupError);
  settings = rig();
  settings.obstacles.assign(max_obstacles + 1, test::fixed_post(3.0, 0.0));
  EXPECT_THROW(RigDynamics::make(settings), SetupError);
}

}  // namespace
}  // namespace flinch
