#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include "plant/hand.h"
#include "plant/obstacle_path.h"
#include "plant/planar_rig.h"
#include "systems/robot/contact_jacobian.h"
#include "tests/plant/servoed_station.h"

namespace flinch {
namespace {

std::vector<PathPoint> there_and_back(double first, double second) {
  return {{.time = first, .displacement = {0.0, 0.0, 0.0}},
          {.time = first + 0.3, .displacement = {-0.25, 0.0, 0.0}},
          {.time = second, .displacement = {-0.25, 0.0, 0.0}},
          {.time = second + 0.3, .displacement = {0.0, 0.0, 0.0}}};
}

// ---------------------------------------------------------------- paths

TEST(ObstaclePath, RestsAtItsPlacesAndItsVelocityIsItsDerivative) {
  const ObstaclePath path(there_and_back(0.2, 1.0));
  for (const PathPoint& place : path.points()) {
    EXPECT_EQ(path.at(place.time).displacement, place.displacement);
    EXPECT_EQ(path.at(place.time).velocity, Eigen::Vector3d::Zero());
  }
  constexpr double h = 1e-6;
  for (double t = -0.1; t < 1.5; t += 0.0137) {
    const Eigen::Vector3d slope = (path.at(t + h).displacement - path.at(t - h).displacement) / (2.0 * h);
    EXPECT_NEAR((path.at(t).velocity - slope).norm(), 0.0, 1e-8);
  }
  EXPECT_EQ(path.at(9.0).displacement, Eigen::Vector3d::Zero());
}

TEST(ObstaclePath, RefusesTimesThatDoNotRiseAndNoPlaces) {
  EXPECT_EQ(ObstaclePath().problems("hand.").size(), 1U);
  const ObstaclePath path({{.time = 1.0}, {.time = 1.0}});
  ASSERT_EQ(path.problems("hand.").size(), 1U);
  EXPECT_EQ(path.problems("hand.")[0],
            "hand.path[1].time is 1 s; it must be later than that of the place before");
}

// ---------------------------------------------------------------- shapes

TEST(Obstacle, RefusesAHullOfPointsInAPlane) {
  ObstacleForm form = test::post_form(0.5, 0.0);
  form.shape = ConvexHull{.points = {{0.0, 0.0, 0.1}, {0.1, 0.0, 0.1}, {0.0, 0.1, 0.1}, {0.1, 0.1, 0.1}}};
  EXPECT_THAT(FixedObstacle(form).problems("post."),
              testing::ElementsAre("post.points lie in a plane; the hull must be at least 0.1 mm thick"));
  std::get<ConvexHull>(form.shape).points.emplace_back(0.0, 0.0, 0.2);
  EXPECT_THAT(FixedObstacle(form).problems("post."), testing::IsEmpty());
}

// ---------------------------------------------------------------- hands

ObstacleForm fist() {
  ObstacleForm form = test::post_form(0.42, 0.0);
  form.name = "hand";
  return form;
}

TEST(Hand, AloneComesToRestWhereItIsLed) {
  const Hand hand(fist(), {.mass = 0.8, .stiffness = 900.0, .damping = 30.0},
                  ObstaclePath(there_and_back(0.0, 2.0)));
  ObstacleMotion now = hand.motion(0.0);
  for (double t = 0.0; t < 1.8; t += 1e-4) {
    now.velocity += 1e-4 * hand.acceleration(t, now, Eigen::Vector3d::Zero());
    now.displacement += 1e-4 * now.velocity;
  }
  EXPECT_NEAR((now.displacement - Eigen::Vector3d(-0.25, 0.0, 0.0)).norm(), 0.0, 1e-4);
  const Eigen::Vector3d push(5.0, 0.0, 0.0);
  EXPECT_NEAR((hand.acceleration(1.8, now, push) - push / 0.8).norm(), 0.0, 0.2) << "m a = f - k x - d v";
}

TEST(Hand, NamesAllThatIsWrongWithIt) {
  const Hand hand(fist(), {.mass = 0.0}, ObstaclePath(), Grip{.times = {2.0, 1.0}, .stiffness = -1.0});
  EXPECT_EQ(hand.problems("hand.").size(), 4U);
}

/// What a scene of several obstacles does, tick by tick.
struct Scene {
  double imbalance = 0.0;  ///< Between forces on obstacles and on the robot [N].
  double wrench_error = 0.0;
  double strongest_pull = 0.0;  ///< Of a hand that holds [N].
  int both_touch = 0;
  int held = 0;
  int last_held = -1;  ///< [ms]
};

Scene run(const SimulatedStationSettings& settings, const test::Path& path, int ticks) {
  test::ServoedStation station(settings, path);
  const auto robot = std::dynamic_pointer_cast<const PlanarRrr>(settings.rig.robot);
  const OutputPort<RigSnapshot> snapshot{station.diagram().tap("station/plant/snapshot").port};
  Scene scene;
  for (int k = 0; k < ticks; ++k) {
    station.step();
    const RigSnapshot& now = station.context().get(snapshot);
    const ContactForces& contacts = now.contacts;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    PlatformVector wrench = PlatformVector::Zero(3);
    Kinematics kinematics;
    robot->kinematics(now.pose, now.velocity, kinematics);
    std::array<int, 2> touches{};
    for (int i = 0; i < contacts.touch_count; ++i) {
      const Touch& touch = contacts.touches[static_cast<std::size_t>(i)];
      sum += touch.force_on_robot;
      ++touches[static_cast<std::size_t>(touch.obstacle)];
      const BodyId body = BodyId::from_index(touch.body);
      const PlanarRig rig(settings.rig);
      const Eigen::Vector3d in_body =
          rig.point_in_body(robot->motion(now.pose, now.velocity), touch.body, touch.point);
      wrench += platform_wrench(robot->contact_jacobian(kinematics, body, in_body.head(2)),
                                touch.force_on_robot.head(2));
      if (!touch.held) continue;
      ++scene.held;
      scene.last_held = k;
      scene.strongest_pull = std::max(scene.strongest_pull, touch.force_on_robot.norm());
    }
    scene.both_touch += touches[0] > 0 && touches[1] > 0 ? 1 : 0;
    scene.imbalance =
        std::max(scene.imbalance, (sum + contacts.on_obstacle[0] + contacts.on_obstacle[1]).norm());
    scene.wrench_error = std::max(scene.wrench_error, (wrench - contacts.obstacle_wrench).norm());
  }
  return scene;
}

TEST(TwoObstaclesAtOnce, BalanceWithTheForcesOnTheRobot) {
  SimulatedStationSettings settings = test::rig_station();
  const CompliantMount arm{.mass = 1.5, .stiffness = 1500.0, .damping = 40.0};
  settings.rig.obstacles = {std::make_shared<const Hand>(fist(), arm, ObstaclePath(there_and_back(0.2, 1.0))),
                            test::compliant_post(-0.172, 0.02)};
  const Scene scene = run(settings, {.amplitude = {0.0, 0.0, 0.0}}, 1600);
  std::cout << "imbalance: " << scene.imbalance << " N, of the platform wrench " << scene.wrench_error << ", "
            << scene.both_touch << " ms between both\n";
  EXPECT_LT(scene.imbalance, 1e-9);
  EXPECT_LT(scene.wrench_error, 1e-9);
  EXPECT_GT(scene.both_touch, 100);
  EXPECT_EQ(scene.held, 0);
}

TEST(HandThatHolds, PullsTheRobotAlongAndLetsGo) {
  SimulatedStationSettings settings = test::rig_station();
  const CompliantMount arm{.mass = 1.5, .stiffness = 1500.0, .damping = 40.0};
  settings.rig.obstacles = {std::make_shared<const Hand>(fist(), arm, ObstaclePath(there_and_back(0.2, 1.0)),
                                                         Grip{.times = {0.8, 1.5}}),
                            test::fixed_post(1.5, 0.0)};
  const Scene scene = run(settings, {.amplitude = {0.0, 0.0, 0.0}}, 1800);
  std::cout << "held for " << scene.held << " ms, pulled with " << scene.strongest_pull << " N\n";
  EXPECT_LT(scene.imbalance, 1e-9);
  EXPECT_LT(scene.wrench_error, 1e-9);
  EXPECT_GT(scene.strongest_pull, 30.0) << "it is drawn back by 25 cm";
  EXPECT_NEAR(scene.held, 700, 2);
  EXPECT_NEAR(scene.last_held, 1500, 2) << "it lets go";
}

TEST(MovingObstacle, PushesTheRobotOutOfItsWay) {
  SimulatedStationSettings settings = test::rig_station();
  settings.rig.obstacles = {
      std::make_shared<const MovingObstacle>(fist(), ObstaclePath(there_and_back(0.2, 1.0)))};
  test::ServoedStation station(settings, {.amplitude = {0.0, 0.0, 0.0}});
  station.advance_to(200ms);
  EXPECT_FALSE(station.contact().in_contact);
  station.advance_to(900ms);
  EXPECT_TRUE(station.contact().in_contact);
  EXPECT_EQ(station.contact().strongest.obstacle, 0);
  EXPECT_LT(station.truth().pose[0], -0.005);
  station.advance_to(1800ms);
  EXPECT_FALSE(station.contact().in_contact);
  EXPECT_EQ(station.contact().contacts, 1);
}

}  // namespace
}  // namespace flinch
