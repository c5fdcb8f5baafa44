#include "plant/general_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "plant/planar_rig.h"
#include "plant/rig_of.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/runge_kutta.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/plant/integrate_rig.h"
#include "tests/plant/moving_rig.h"
#include "tests/plant/random_rig.h"
#include "tests/plant/rig_scene.h"

namespace flinch {
namespace {

std::shared_ptr<const Hexapod> hexapod(HexapodFriction friction = HexapodFriction::none) {
  return std::make_shared<const Hexapod>(hexapod_robot(HexapodPayload::eccentric, friction));
}

std::shared_ptr<const FiveBar> five_bar() { return std::make_shared<const FiveBar>(five_bar_robot()); }

// ---------------------------------------------------------------- against the closed forms of the planar
// robot

TEST(GeneralRig, MovesThePlanarRobotAsItsClosedFormsDo) {
  test::RandomRig random(51, RigFriction::test_rig);
  RigSettings settings;
  settings.robot = random.shared;
  settings.obstacles = {test::fixed_post(0.9, 0.9)};
  const RigOf<GeneralRig> general(settings);
  const RigOf<PlanarRig> planar(settings);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const PlanarMotion motion = random.motion();
    RigState state = planar.initial_state();
    state.head<3>() = motion.pose;
    state.segment<3>(3) = motion.velocity;
    RigStep step;
    step.chart = planar.initial_step().chart;  // no contact: no candidates
    DriveAction drives;
    drives.torque = Eigen::Vector3d(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), 3.0);
    drives.braked = i % 2 == 0;
    const PlatformVector wrench = Eigen::Vector3d(random.uniform(-50.0, 50.0), 10.0, 1.0);
    RigState expected;
    RigState found;
    planar.rates(state, drives, wrench, step, expected);
    general.rates(state, drives, wrench, step, found);
    worst = std::max(worst, (found - expected).norm() / (1.0 + expected.norm()));
  }
  std::cout << "largest relative difference: " << worst << "\n";
  EXPECT_LT(worst, 1e-10);
}

TEST(GeneralRig, PushesThePlatformOfThePlanarRobotAsItsClosedFormsDo) {
  test::RandomRig random(52);
  RigSettings settings;
  settings.robot = random.shared;
  settings.obstacles = {test::fixed_post(0.0, 0.0, {.friction = 0.3})};
  settings.link_material.reset();
  const RigOf<GeneralRig> general(settings);
  const RigOf<PlanarRig> planar(settings);
  double worst = 0.0;
  int touched = 0;
  for (int i = 0; i < 2000; ++i) {
    const PlanarMotion motion = random.motion();
    const double angle = random.uniform(-3.1, 3.1);
    PlacedObstacles obstacles;
    obstacles[0].position << motion.pose.head<2>() + 0.17 * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
        0.0;
    obstacles[0].velocity << random.point(0.5), 0.0;
    GeneralRig::Instant now;
    random.robot.kinematics(motion.pose, motion.velocity, now.kinematics);
    ContactForces expected(3);
    ContactForces found(3);
    planar.find_forces(motion, obstacles, {}, ContactCandidates::all(), expected);
    general.find_forces(now, obstacles, {}, ContactCandidates::all(), found);
    if (found.touch_count != 1 || expected.touch_count != 1 || found.touches[0].body != 0) continue;
    ++touched;
    worst = std::max(worst, (found.obstacle_wrench - expected.obstacle_wrench).norm());
    worst = std::max(worst, (found.touches[0].point - expected.touches[0].point).norm());
  }
  std::cout << "largest difference: " << worst << " N, Nm, m in " << touched << " contacts\n";
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(touched, 800);
}

// ---------------------------------------------------------------- the chart

// The chart's pose moves along, so that xi may grow beyond pi while the platform turns.
TEST(HexapodInFreeMotion, KeepsItsEnergyHoweverFarItTurns) {
  HexapodParameters parameters = hexapod_robot();
  parameters.gravity.setZero();
  RigSettings settings;
  settings.robot = std::make_shared<const Hexapod>(parameters);
  settings.initial_velocity = PlatformVector{{0.05, -0.02, 0.03, 0.5, -0.4, 0.6}};
  settings.link_material.reset();
  test::MovingRig moving(settings);
  const double start = moving.now.kinetic_energy;
  double drift = 0.0;
  double turned = 0.0;
  for (int k = 0; k < 600 && moving.now.reachable; ++k) {
    moving.tick();
    drift = std::max(drift, std::abs(moving.now.kinetic_energy / start - 1.0));
    turned = std::max(turned, moving.rig->robot().space().rotation_angle(moving.now.pose));
    EXPECT_NEAR(moving.now.pose.tail<4>().norm(), 1.0, 1e-14);
  }
  std::cout << "relative drift of the energy: " << drift << " while it turned by " << turned << " rad\n";
  EXPECT_LT(drift, 1e-9);
  EXPECT_GT(turned, 0.2);
}

TEST(HexapodInFreeMotion, FollowsTinyFixedStepsFromAFixedChart) {
  RigSettings settings;
  settings.robot = hexapod();
  settings.initial_velocity = PlatformVector{{0.3, -0.2, 0.3, 1.0, -0.8, 1.2}};
  test::MovingRig moving(settings);
  test::RigEquation reference(*moving.rig);  // one chart for all ticks
  reference.drives = moving.equation.drives;
  reference.step.search.candidates = {};
  std::vector<double> y = std::vector<double>(moving.y);
  RungeKutta tiny(20);
  tiny.prepare(y.size());
  double worst = 0.0;
  for (int k = 0; k < 100; ++k) {
    moving.tick();
    tiny.advance(reference, 1e-3, y);
    const RigState state = Eigen::Map<const Eigen::VectorXd>(y.data(), 12);
    RigSnapshot there;
    moving.rig->snapshot(state, reference.drives, reference.applied_wrench, reference.step, 0.0, there);
    worst = std::max(worst, moving.rig->robot().difference(there.pose, moving.now.pose).norm());
    worst = std::max(worst, (there.velocity - moving.now.velocity).norm());
  }
  std::cout << "chart by chart against one chart: " << worst << "\n";
  EXPECT_LT(worst, 1e-9);
}

// ---------------------------------------------------------------- energy with contacts in space

double spring_energy(const RigSnapshot& now, double stiffness) {
  double energy = 0.0;
  for (int i = 0; i < now.contacts.touch_count; ++i) {
    energy += 0.5 * stiffness * std::pow(now.contacts.touches[static_cast<std::size_t>(i)].depth, 2);
  }
  return energy;
}

// d/dt (T + sum k d^2/2) = drives + gravity - friction, where contacts are elastic.
TEST(HexapodAmongElasticObstacles, KeepsTheBalanceOfItsEnergy) {
  const ContactMaterial elastic{.stiffness = 2e4, .restitution = 1.0};
  RigSettings settings;
  settings.robot = hexapod(HexapodFriction::ball_screws);
  settings.initial_velocity = PlatformVector{{0.6, 0.1, 0.0, 0.2, 0.3, 0.4}};
  ObstacleForm ball{.name = "ball", .position_in_base = {0.40, 0.02, 0.62}, .material = elastic};
  ball.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.08};
  ObstacleForm bar{.name = "bar", .position_in_base = {0.0, 0.36, 0.64}, .material = elastic};
  bar.shape = Capsule{.begin = {-0.3, 0.0, 0.0}, .end = {0.3, 0.0, 0.0}, .radius = 0.03};
  settings.obstacles = {std::make_shared<const FixedObstacle>(ball),
                        std::make_shared<const CompliantObstacle>(bar, CompliantMount{.damping = 0.0})};
  const SundialsOptions tight{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-11};
  test::MovingRig moving(settings, tight);
  ASSERT_EQ(moving.now.contacts.touch_count, 0);
  const double start = moving.now.kinetic_energy;
  double imbalance = 0.0;
  double of_springs = 0.0;
  int in_contact = 0;
  for (int k = 0; k < 400; ++k) {
    moving.equation.drives.torque << 30.0 * std::sin(0.02 * k), 35.0, 30.0, 35.0, 30.0, 40.0;
    moving.tick();
    ASSERT_TRUE(moving.now.reachable) << k;
    imbalance = std::max(imbalance, std::abs(moving.now.kinetic_energy - start - moving.work()));
    of_springs = std::max(of_springs, spring_energy(moving.now, elastic.stiffness));
    in_contact += moving.now.contacts.touch_count > 0 ? 1 : 0;
    Eigen::Vector3d on_robot = Eigen::Vector3d::Zero();
    for (int i = 0; i < moving.now.contacts.touch_count; ++i) {
      on_robot += moving.now.contacts.touches[static_cast<std::size_t>(i)].force_on_robot;
    }
    EXPECT_NEAR((on_robot + moving.now.contacts.on_obstacle[0] + moving.now.contacts.on_obstacle[1]).norm(),
                0.0, 1e-9);
  }
  std::cout << "imbalance of the energy: " << imbalance << " J, at most " << of_springs << " J in springs, "
            << in_contact << " ms in contact\n";
  EXPECT_LT(imbalance, 1e-6);
  EXPECT_GT(in_contact, 30);
}

/// What a contact with the ball loses: (k d - f_n) d' by its damper, -f_t . v_t by friction [W].
double lost_power(const Mechanism& robot, const RigSnapshot& now, const Touch& touch, double stiffness) {
  Kinematics at;
  robot.kinematics(now.pose, now.velocity, at);
  const BodyId body = BodyId::from_index(touch.body);
  const auto in_base = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return robot.point_on_body(at, body, point);
  };
  const Eigen::Vector3d origin = in_base(Eigen::Vector3d::Zero());
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = in_base(Eigen::Vector3d::Unit(i)) - origin;
  const ContactJacobian there = robot.contact_jacobian(at, body, axes.transpose() * (touch.point - origin));
  const Eigen::Vector3d velocity = there.translation * now.velocity;
  const PlacedObstacle& ball = now.obstacles[static_cast<std::size_t>(touch.obstacle)];
  const Eigen::Vector3d normal = (touch.point - ball.position).normalized();  // out of the ball
  const double depth_rate = -normal.dot(velocity - ball.velocity);
  const double normal_force = normal.dot(touch.force_on_robot);
  const Eigen::Vector3d friction = touch.force_on_robot - normal_force * normal;
  return (normal_force - stiffness * touch.depth) * depth_rate - friction.dot(velocity - ball.velocity);
}

// d/dt (T + sum k d^2/2) = drives + gravity - friction of joints - what contacts lose, each by its own law.
TEST(HexapodAmongRoughBalls, LosesWhatDampersAndFrictionTake) {
  const ContactMaterial rough{.stiffness = 2e4, .restitution = 0.5, .friction = 0.4};
  RigSettings settings;
  settings.robot = hexapod(HexapodFriction::ball_screws);
  settings.initial_velocity = PlatformVector{{0.6, 0.1, 0.0, 0.2, 0.3, 0.4}};
  settings.link_material.reset();
  const auto ball = [&](const char* name, const Eigen::Vector3d& at) {
    ObstacleForm form{.name = name, .position_in_base = at, .material = rough};
    form.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.08};
    return std::make_shared<const FixedObstacle>(form);
  };
  settings.obstacles = {ball("beside", {0.40, 0.02, 0.62}), ball("behind", {0.02, 0.40, 0.64})};
  test::MovingRig moving(settings, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-11});
  ASSERT_EQ(moving.now.contacts.touch_count, 0);
  const auto loss_now = [&] {
    double loss = 0.0;
    for (int i = 0; i < moving.now.contacts.touch_count; ++i) {
      loss += lost_power(*settings.robot, moving.now,
                         moving.now.contacts.touches[static_cast<std::size_t>(i)], rough.stiffness);
    }
    return loss;
  };
  const double start = moving.now.kinetic_energy;
  constexpr double tick = 5e-5;
  double imbalance = 0.0, lost = 0.0, power = loss_now();
  int in_contact = 0;
  for (int k = 0; k < 5000; ++k) {
    moving.equation.drives.torque << 30.0 * std::sin(0.001 * k), 35.0, 30.0, 35.0, 30.0, 40.0;
    moving.tick(tick);
    ASSERT_TRUE(moving.now.reachable) << k;
    const double before = power;
    power = loss_now();
    EXPECT_GE(power, -1e-9) << "a contact gives energy";
    lost += 0.5 * tick * (before + power);
    const auto works = std::span(moving.y).last(test::RigEquation::works);
    const double of_others = works[0] + works[1] - works[3];  // drives, gravity, less friction of joints
    const double stored = spring_energy(moving.now, rough.stiffness);
    imbalance = std::max(imbalance, std::abs(moving.now.kinetic_energy + stored + lost - start - of_others));
    in_contact += moving.now.contacts.touch_count > 0 ? 1 : 0;
  }
  std::cout << "imbalance of the energy: " << imbalance << " J, " << lost << " J lost in contacts of "
            << tick * in_contact << " s\n";
  EXPECT_LT(imbalance, 2e-5);
  EXPECT_GT(lost, 0.1);
}

TEST(FiveBarRig, IsPushedByAPostInItsPlane) {
  RigSettings settings;
  settings.robot = five_bar();
  settings.initial_velocity = PlatformVector{{0.0, 0.5}};
  ObstacleForm post = test::post_form(0.0, 0.58);
  post.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.2};
  settings.obstacles = {std::make_shared<const FixedObstacle>(post)};
  test::MovingRig moving(settings);
  const double start = moving.now.kinetic_energy;
  int in_contact = 0;
  for (int k = 0; k < 130; ++k) {
    moving.tick();
    ASSERT_TRUE(moving.now.reachable);
    in_contact += moving.now.contacts.touch_count > 0 ? 1 : 0;
    EXPECT_NEAR(moving.now.kinetic_energy - start - moving.work(), 0.0, 1e-7);
  }
  EXPECT_GT(in_contact, 10);
  EXPECT_LT(moving.now.velocity[1], 0.0) << "it was thrown back";
}

TEST(GeneralBenchCandidates, MissNoContactOfATick) {
  RigSettings settings;
  settings.robot = hexapod();
  ObstacleForm ball{.name = "ball"};
  ball.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = 0.05};
  settings.obstacles = {std::make_shared<const FixedObstacle>(ball)};
  const GeneralRig rig(settings);
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto random_vector = [&](double size) -> Eigen::Vector3d {
    return size * Eigen::Vector3d(unit(generator), unit(generator), unit(generator));
  };
  const Mechanism& robot = *settings.robot;
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    PlatformVector xi(6);
    xi << random_vector(0.05), random_vector(0.2);
    PlatformVector v(6);
    v << random_vector(1.0), random_vector(3.0);
    const Configuration pose = robot.space().plus(robot.home_pose(), xi);
    GeneralRig::Instant now;
    robot.kinematics(pose, v, now.kinematics);
    ASSERT_TRUE(now.kinematics.reachable);
    PlacedObstacles obstacles;
    obstacles[0] = {pose.head<3>() + random_vector(0.35), random_vector(1.0)};
    const ContactCandidates candidates = rig.find_candidates(now, obstacles, 1e-3).candidates;
    for (const double t : {0.0, 5e-4, 1e-3}) {
      GeneralRig::Instant later;
      robot.kinematics(robot.space().plus(pose, t * v), v, later.kinematics);
      PlacedObstacles moved = obstacles;
      moved[0].position += t * obstacles[0].velocity;
      const auto count = [&](const ContactCandidates& of) {
        int contacts = 0;
        rig.for_each_gap(
            later, moved, of, [&](int, int, const SurfaceGap&) { ++contacts; },
            [&](int, int, const SurfaceGap&) { ++contacts; });
        return contacts;
      };
      const int contacts = count(ContactCandidates::all());
      touching += contacts;
      EXPECT_EQ(count(candidates), contacts);
    }
  }
  EXPECT_GT(touching, 50);
}

}  // namespace
}  // namespace flinch
