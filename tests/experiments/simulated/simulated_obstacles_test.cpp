#include "experiments/simulated/simulated_obstacles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/verdict.h"
#include "plant/compliant_obstacle.h"
#include "plant/contact_truth.h"
#include "plant/hand.h"
#include "plant/narrow_phase.h"
#include "systems/framework/recorded_values.h"
#include "systems/framework/recording.h"
#include "tests/support/problems_of.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

SimulatedScenario scenario_with(const std::string& obstacles, const std::string& more = "") {
  const test::Workplace place;
  place.write("scenarios/own.yaml",
              "robot: ../robots/planar_3rrr.yaml\nduration_s: 1.5\n" + more + "obstacles:\n" + obstacles);
  return read_simulated_scenario(place / "scenarios/own.yaml");
}

std::vector<std::string> problems_with(const std::string& obstacles) {
  return test::problems_of([&] { scenario_with(obstacles); });
}

Verdict verdict_on(const SimulatedScenario& scenario) {
  const Recording recording = run_experiment(scenario);
  return judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
}

TEST(ScenarioObstacles, AreOfTheKindThatTheyName) {
  const SimulatedScenario scenario = scenario_with(
      "  - {x_m: 0.6, y_m: 0.6}\n"
      "  - {name: rail, shape: capsule, x_m: 0, y_m: 0.7, axis_m: [0.4, 0, 0], kind: compliant, mass_kg: 3}\n"
      "  - {name: crate, shape: box, x_m: -0.7, y_m: 0.7, size_m: [0.1, 0.2, 0.3], kind: path, path: "
      "[{time_s: 1, "
      "x_m: 0.1}]}\n"
      "  - {name: hand, x_m: 0.7, y_m: -0.7, kind: hand, path: [{time_s: 1}], grip: {begin_s: 1, end_s: "
      "2}}\n");
  const Obstacles& obstacles = scenario.station.rig.obstacles;
  ASSERT_EQ(obstacles.size(), 4U);
  EXPECT_EQ(obstacles[0]->form().name, "obstacle 1");
  EXPECT_EQ(std::get<Sphere>(obstacles[0]->form().shape).radius, 0.04);
  EXPECT_EQ(std::get<Capsule>(obstacles[1]->form().shape).end, Eigen::Vector3d(0.2, 0.0, 0.0));
  EXPECT_EQ(dynamic_cast<const CompliantObstacle&>(*obstacles[1]).mount().mass, 3.0);
  EXPECT_EQ(std::get<Box>(obstacles[2]->form().shape).half_lengths, Eigen::Vector3d(0.05, 0.1, 0.15));
  EXPECT_EQ(dynamic_cast<const MovingObstacle&>(*obstacles[2]).path().points().front().displacement.x(), 0.1);
  ASSERT_NE(obstacles[3]->holding(), nullptr);
  EXPECT_EQ(obstacles[3]->holding()->end, 2.0);
}

TEST(ScenarioObstacles, MayNotBeginInContactAndAreNamedByTheirOwnLine) {
  const std::string post = "  - {name: post, x_m: 0.15, y_m: 0}\n";
  EXPECT_THAT(
      problems_with("  - {name: far, x_m: 0.7, y_m: 0.7}\n" + post),
      ElementsAre(
          HasSubstr("own.yaml:5: obstacles[1]: begins in contact: platform is 27 mm deep in post"),
          HasSubstr("own.yaml:5: obstacles[1]: begins in contact: leg1_link2 is 33.6 mm deep in post")));
  EXPECT_THAT(
      test::problems_of([&] { scenario_with(post, "pylon: {x_m: -0.15, y_m: 0}\n"); }),
      ElementsAre(HasSubstr("own.yaml:3: pylon: begins in contact: platform is 27 mm deep in pylon"),
                  HasSubstr("own.yaml:5: obstacles[0]: begins in contact: platform is 27 mm deep in post"),
                  HasSubstr("own.yaml:5: obstacles[0]: begins in contact: leg1_link2 is 33.6 mm deep")));
}

// ---------------------------------------------------------------- boxes that are turned, and hulls

/// The eight corners of a cube of 100 mm about its position, one on each line.
const std::string cube_corners =
    "[{x_mm: -50, y_mm: -50, z_mm: -50},\n {x_mm: 50, y_mm: -50, z_mm: -50},\n"
    " {x_mm: -50, y_mm: 50, z_mm: -50},\n {x_mm: 50, y_mm: 50, z_mm: -50},\n"
    " {x_mm: -50, y_mm: -50, z_mm: 50},\n {x_mm: 50, y_mm: -50, z_mm: 50},\n"
    " {x_mm: -50, y_mm: 50, z_mm: 50},\n {x_mm: 50, y_mm: 50, z_mm: 50}]";

const std::string standing_on_its_edge = "x_m: 0.5, y_m: 0, rotation_deg: [0, 0, 45]";

/// Of the platform at home from the obstacle.
double gap_to_platform(const SimulatedScenario& scenario) {
  const ParallelRobot& robot = *scenario.robot.robot;
  const ObstacleForm& form = scenario.station.rig.obstacles.front()->form();
  Placement home;
  home.origin.head<2>() = robot.home_pose().head<2>();
  return nearest(Solid(robot.body(BodyId::platform()).shapes.front()), home, Solid(form.shape),
                 {.origin = form.position_in_base})
      .gap;
}

TEST(ScenarioObstacles, MayBeTurned) {
  const double from_edge = 0.5 - 0.05 * std::sqrt(2.0) - 0.137;  // less half a diagonal and the platform
  EXPECT_NEAR(gap_to_platform(scenario_with("  - {shape: box, " + standing_on_its_edge + "}\n")), from_edge,
              1e-12);
  EXPECT_NEAR(gap_to_platform(scenario_with("  - {shape: hull, points: " + cube_corners + ", " +
                                            standing_on_its_edge + "}\n")),
              from_edge, 1e-12);
  // About the diagonal of the cube x goes to y and back to x after 120 degrees.
  const std::string turned = "rotation_deg: [69.2820323027551, 69.2820323027551, 69.2820323027551]";
  EXPECT_NEAR(gap_to_platform(scenario_with("  - {shape: box, x_m: 0.5, y_m: 0, size_mm: [40, 60, 80], " +
                                            turned + "}\n")),
              0.5 - 0.04 - 0.137, 1e-12)
      << "its edge of 80 mm lies along x now";
}

TEST(ScenarioObstacles, AreStruckAlikeAsBoxAndAsHull) {
  const std::string crate =
      "x_mm: -260, y_mm: -20, rotation_deg: [20, 10, 30], kind: path, path: [{time_s: 0.4}, {time_s: 0.6, "
      "x_mm: "
      "90}]}\n";
  const Verdict of_box = verdict_on(scenario_with("  - {name: crate, shape: box, " + crate));
  const Verdict of_hull =
      verdict_on(scenario_with("  - {name: crate, shape: hull, points: " + cube_corners + ", " + crate));
  ASSERT_EQ(of_box.contacts.size(), 1U);
  ASSERT_EQ(of_hull.contacts.size(), 1U);
  EXPECT_EQ(of_box.contacts[0].body, "platform");
  EXPECT_EQ(of_hull.contacts[0].body, "platform");
  EXPECT_GT(of_box.contacts[0].peak_force, 20.0);
  EXPECT_NEAR(of_hull.contacts[0].peak_force, of_box.contacts[0].peak_force, 1e-6);
  EXPECT_NEAR(of_hull.contacts[0].onset, of_box.contacts[0].onset, 1e-9);
}

TEST(ScenarioObstacles, AreRefusedAsHullsThatEncloseNothing) {
  const auto hull = [](const std::string& points) {
    return "  - {name: far, x_m: 0.7, y_m: 0.7}\n  - {x_m: 0.7, y_m: -0.7, shape: hull,\n     " + points +
           "}\n";
  };
  EXPECT_THAT(
      problems_with(hull("points: [{x_m: 0, y_m: 0, z_m: 0}, {x_m: 0, y_m: 1, z_m: 0}]")),
      ElementsAre(HasSubstr("own.yaml:6: obstacles[1].points: has 2 entries; a hull needs at least 4")));
  EXPECT_THAT(
      problems_with(hull("points: [{x_m: 0, y_m: 0, z_m: 0}, {x_m: 0, y_m: 1, z_m: 0}, {x_m: 1, y_m: 0, z_m: "
                         "0}, {x_m: 1, y_m: 1, z_m: 0}]")),
      ElementsAre(
          HasSubstr("own.yaml:6: obstacles[1].points: lie in a plane; the hull must be at least 0.1 mm")));
  std::string many = "points: [";
  for (int i = 0; i < 129; ++i) many += "{x_mm: " + std::to_string(i % 7) + ", y_mm: 0, z_mm: 0}, ";
  EXPECT_THAT(problems_with(hull(many + "]")),
              ElementsAre(HasSubstr(
                  "own.yaml:6: obstacles[1].points: has 129 entries; a hull may have at most 128")));
  EXPECT_THAT(problems_with(hull("rotation_deg: [0, 0, 0]")),
              ElementsAre(HasSubstr("own.yaml:5: obstacles[1].points: is missing")));
  EXPECT_THAT(problems_with(hull("points: [{x_m: 0, y_m: 0, z_m: 0}, {x_m: 0, y_m: 1}]")),
              ElementsAre(HasSubstr("own.yaml:6: obstacles[1].points[1].z_m: is missing")));
  EXPECT_THAT(problems_with("  - {x_m: 0.7, y_m: 0.7, rotation_deg: [0, 0, 45]}\n"),
              ElementsAre(HasSubstr("own.yaml:4: obstacles[0].rotation_deg: is not a known key")))
      << "a sphere looks alike from all sides";
}

TEST(ScenarioObstacles, AreRefusedWhereTheyCannotBeToldApartOrMoveBackInTime) {
  EXPECT_THAT(problems_with("  - {name: post, x_m: 0.7, y_m: 0.7}\n  - {name: post, x_m: -0.7, y_m: 0.7}\n"),
              ElementsAre(HasSubstr("as that of another obstacle is")));
  EXPECT_THAT(
      problems_with("  - {x_m: 0.7, y_m: 0.7, kind: path, path: [{time_s: 1}, {time_s: 0.5, x_m: 0.1}]}\n"),
      ElementsAre(HasSubstr("own.yaml:4")));
  EXPECT_THAT(problems_with("  - {x_m: 0.7, y_m: 0.7, kind: hnad}\n"), ElementsAre(HasSubstr("hand")));
}

/// The platform rests; first a hand strikes it and is drawn back, later a crate is driven into it.
TEST(ScenarioObstacles, AreToldApartByTheVerdict) {
  const SimulatedScenario scenario = scenario_with(
      "  - {name: hand, x_m: -0.24, y_m: 0, kind: hand, path: [{time_s: 0.4}, {time_s: 0.55, x_m: 0.08}, "
      "{time_s: "
      "0.7}]}\n"
      "  - {name: crate, shape: box, x_m: -0.45, y_m: -0.15, size_m: [0.06, 0.06, 0.06], kind: path, path: "
      "[{time_s: 0.9}, {time_s: 1.3, x_m: 0.4, y_m: 0.13}]}\n");
  const Verdict verdict = verdict_on(scenario);
  ASSERT_EQ(verdict.contacts.size(), 2U);
  EXPECT_EQ(verdict.contacts[0].obstacle, 0);
  EXPECT_EQ(verdict.contacts[1].obstacle, 1);
  for (const ContactVerdict& contact : verdict.contacts) EXPECT_EQ(contact.body, "platform");
  EXPECT_TRUE(verdict.contacts[0].detected.has_value());
  EXPECT_TRUE(verdict.contacts[0].removed.has_value());
  EXPECT_EQ(verdict.false_detections, 0);
}

/// A hand presses the platform from -x while a crate is driven in from +x.
TEST(ScenarioObstacles, AreToldApartWhereTheyTouchAtOnce) {
  const SimulatedScenario scenario = scenario_with(
      "  - {name: hand, x_m: -0.24, y_m: 0, kind: hand, path: [{time_s: 0.4}, {time_s: 0.7, x_m: 0.08}, "
      "{time_s: 1.0}]}\n"
      "  - {name: crate, x_m: 0.25, y_m: 0, kind: path, path: [{time_s: 0.45}, {time_s: 0.75, x_m: -0.08}, "
      "{time_s: 1.0}]}\n");
  const Recording recording = run_experiment(scenario);
  const Verdict verdict =
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  ASSERT_EQ(verdict.contacts.size(), 2U);
  EXPECT_EQ(verdict.contacts[0].obstacle_name, "hand");
  EXPECT_EQ(verdict.contacts[1].obstacle_name, "crate");
  // The peaks of the truth, touch by touch.
  std::array<double, 2> peak{}, first{INFINITY, INFINITY};
  int both = 0;
  const RecordedValues<ContactTruth> truth(recording, "contact");
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const ContactTruth now = truth[k];
    std::array<double, 2> force{};
    for (const TouchTruth& touch : {now.strongest, now.second, now.further[0], now.further[1]}) {
      if (touch.body < 0) continue;
      const auto place = static_cast<std::size_t>(touch.obstacle);
      force[place] = std::max(force[place], touch.force_in_base.norm());
    }
    for (std::size_t i = 0; i < 2; ++i) {
      peak[i] = std::max(peak[i], force[i]);
      if (force[i] > 1.0) first[i] = std::min(first[i], 1e-3 * static_cast<double>(k));
    }
    both += force[0] > 1.0 && force[1] > 1.0 ? 1 : 0;
  }
  EXPECT_GT(both, 20);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(verdict.contacts[i].peak_force, peak[i]);
    EXPECT_LE(verdict.contacts[i].onset, first[i]);
    EXPECT_GT(verdict.contacts[i].onset, first[i] - 1e-3);
  }
}

TEST(ScenarioObstacles, HoldUntilTheyLetGo) {
  const SimulatedScenario scenario = scenario_with(
      "  - {name: hand, x_m: 0.25, y_m: 0, kind: hand, path: [{time_s: 0.4}, {time_s: 0.6, x_m: -0.08}], "
      "grip: "
      "{begin_s: 0.5, end_s: 1.1}}\n");
  const Verdict verdict = verdict_on(scenario);
  ASSERT_EQ(verdict.contacts.size(), 1U);
  ASSERT_TRUE(verdict.contacts[0].removed.has_value());
  EXPECT_NEAR(*verdict.contacts[0].removed, 1.1, 0.01);
}

}  // namespace
}  // namespace flinch
