#include "experiments/campaign/drawn_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/parallel_robot.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

constexpr double radius = 0.03;

Scenario moving() { return read_scenario(test::shipped("scenarios/platform_collision.yaml")); }

Kinematics half_way(const Scenario& scenario) {
  const PlatformPath& path = *scenario.control.trajectory.path;
  const PlatformReference reference = path.evaluate(0.5 * path.duration());
  Kinematics now;
  scenario.robot.robot->kinematics(reference.pose, reference.velocity, now);
  return now;
}

/// Of a point in the plane from a segment.
double distance(const Eigen::Vector2d& point, const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  const Eigen::Vector2d along = end - begin;
  const double share = std::clamp((point - begin).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - begin - share * along).norm();
}

/// The gap between the obstacle and a link, by the ends of the link and not by its shape.
double gap(const Scenario& scenario, const Kinematics& now, int leg, int link, const DrawnContact& contact) {
  const LegPoints& points = now.legs[static_cast<std::size_t>(leg)];
  const auto& shape = std::get<Capsule>(
      scenario.robot.robot->body(link == 1 ? BodyId::link1(leg) : BodyId::link2(leg)).shapes.front());
  const Eigen::Vector2d begin = link == 1 ? points.base_joint : points.passive_joint;
  const Eigen::Vector2d end = link == 1 ? points.passive_joint : points.coupling_joint;
  return distance(contact.position_in_base.head<2>(), begin, end) - shape.radius - radius;
}

template <class Check>
int drawn(const char* kind, Check&& check, double largest_gap = 0.0) {
  const Scenario scenario = moving();
  RandomGenerator random(4);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const auto contact = draw_contact(scenario, kind, Sphere{.radius = radius}, random, largest_gap);
    if (!contact) continue;
    ++found;
    check(scenario, half_way(scenario), *contact);
  }
  return found;
}

TEST(ADrawnContact, WithALinkTouchesJustThatLink) {
  for (const int link : {1, 2}) {
    const int found =
        drawn(link == 1 ? "link1" : "link2",
              [link](const Scenario& scenario, const Kinematics& now, const DrawnContact& contact) {
                const int leg = contact.body[3] - '1';
                for (int other = 0; other < scenario.robot.robot->legs(); ++other) {
                  for (const int part : {1, 2}) {
                    const double between = gap(scenario, now, other, part, contact);
                    if (other == leg && part == link) {
                      EXPECT_NEAR(between, 0.0, 1e-9) << contact.body;
                    } else {
                      EXPECT_GE(between, 0.0) << contact.body;
                    }
                  }
                }
              });
    EXPECT_GT(found, 50);
  }
}

TEST(ADrawnContact, StandsInTheWayOfWhatMoves) {
  drawn("link2", [](const Scenario& scenario, const Kinematics& now, const DrawnContact& contact) {
    Kinematics later;
    const PlatformPath& path = *scenario.control.trajectory.path;
    const PlatformReference reference = path.evaluate(0.5 * path.duration() + 1e-3);
    scenario.robot.robot->kinematics(reference.pose, reference.velocity, later);
    const int leg = contact.body[3] - '1';
    EXPECT_LT(gap(scenario, later, leg, 2, contact), gap(scenario, now, leg, 2, contact)) << contact.body;
  });
}

TEST(ADrawnClamping, TouchesBothLinksOfALegThatCloses) {
  const int found =
      drawn("clamping", [](const Scenario& scenario, const Kinematics& now, const DrawnContact& contact) {
        const int leg = contact.body[3] - '1';
        EXPECT_NEAR(gap(scenario, now, leg, 1, contact), 0.0, 1e-9);
        EXPECT_NEAR(gap(scenario, now, leg, 2, contact), 0.0, 1e-9);
      });
  EXPECT_GT(found, 10);
}

TEST(ADrawnClamping, WithAGapTouchesOneLinkWhichIsDrawn) {
  int first_links = 0;
  const int found = drawn(
      "clamping",
      [&first_links](const Scenario& scenario, const Kinematics& now, const DrawnContact& contact) {
        const int leg = contact.body[3] - '1';
        const double gap1 = gap(scenario, now, leg, 1, contact), gap2 = gap(scenario, now, leg, 2, contact);
        EXPECT_NEAR(std::min(gap1, gap2), 0.0, 1e-9);
        EXPECT_GT(std::max(gap1, gap2), 1e-6);
        EXPECT_LT(std::max(gap1, gap2), 0.01);
        first_links += gap1 < gap2 ? 1 : 0;
      },
      0.01);
  EXPECT_GT(first_links, 5);
  EXPECT_GT(found - first_links, 5);
}

TEST(ADrawnContact, WithThePlatformIsOnTheSideToWhichItMoves) {
  const int found =
      drawn("platform", [](const Scenario&, const Kinematics& now, const DrawnContact& contact) {
        const Eigen::Vector2d away = contact.position_in_base.head<2>() - now.pose.head<2>();
        EXPECT_GT(away.dot(Eigen::Vector2d(now.velocity.head<2>())), 0.0);
      });
  EXPECT_GT(found, 50);
}

ConvexHull prism(double low_x, double high_x) {
  ConvexHull hull;
  for (const double x : {low_x, high_x}) {
    for (const double y : {-0.02, 0.03}) {
      for (const double z : {-0.05, 0.05}) hull.points.emplace_back(x, y, z);
    }
  }
  return hull;
}

TEST(ADrawnContact, PlacesAHullThatHoldsItsPosition) {
  const Scenario scenario = moving();
  const Eigen::Vector2d platform = half_way(scenario).pose.head<2>();
  RandomGenerator random(4);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const auto contact = draw_contact(scenario, "platform", prism(-0.01, 0.04), random);
    if (!contact) continue;
    ++found;
    const Eigen::Vector2d from = platform - contact->position_in_base.head<2>();
    const Eigen::Vector2d nearest(std::clamp(from.x(), -0.01, 0.04), std::clamp(from.y(), -0.02, 0.03));
    EXPECT_NEAR((from - nearest).norm(), 0.137, 1e-9) << "the radius of the platform";
  }
  EXPECT_GT(found, 20);
  EXPECT_THROW(draw_contact(scenario, "platform", prism(0.01, 0.04), random), SetupError);
}

TEST(ADrawnContact, IsFoundInSpaceToo) {
  const Scenario scenario = read_scenario(test::shipped("scenarios/hexapod_collision.yaml"));
  RandomGenerator random(4);
  int found = 0;
  for (int i = 0; i < 30; ++i)
    found += draw_contact(scenario, "platform", Sphere{.radius = radius}, random) ? 1 : 0;
  EXPECT_GT(found, 10);
}

}  // namespace
}  // namespace flinch
