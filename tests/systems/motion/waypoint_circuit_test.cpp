#include "systems/motion/waypoint_circuit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr ConfigurationSpace plane = ConfigurationSpace::Kind::planar_pose;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
/// The contact-free motion: 300 mm, 1.5 m/s, 12 m/s^2.
constexpr double side = 0.3;
const PoseLimits limits{{1.5, 12.0, 1200.0}, {4.0, 80.0, 8000.0}};

WaypointCircuit square(int laps) {
  return WaypointCircuit::plan(plane, square_corners(Vector3d(0.01, -0.02, 0.1), side), limits, laps);
}

TEST(SquareCorners, GoRoundCounterClockwiseWithTheOrientationOfTheCentre) {
  const auto corners = square_corners(Vector3d(1.0, 2.0, 0.5), 0.5);
  EXPECT_EQ(corners[0], Vector3d(0.75, 1.75, 0.5));
  EXPECT_EQ(corners[1], Vector3d(1.25, 1.75, 0.5));
  EXPECT_EQ(corners[2], Vector3d(1.25, 2.25, 0.5));
  EXPECT_EQ(corners[3], Vector3d(0.75, 2.25, 0.5));
}

TEST(WaypointCircuit, GoesRoundTheSquareAtFullSpeedAndRestsAtItsCorners) {
  const auto circuit = square(1);
  ASSERT_TRUE(circuit.valid());
  // From rest to rest with cruise: v/a + a/j + d/v for each side.
  const double leg = 1.5 / 12.0 + 12.0 / 1200.0 + side / 1.5;
  EXPECT_NEAR(circuit.duration(), 4 * leg, 1e-12);
  const auto corners = square_corners(Vector3d(0.01, -0.02, 0.1), side);
  for (std::size_t i = 0; i < 4; ++i) {
    const PlatformReference at_corner = circuit.evaluate(static_cast<double>(i) * leg);
    EXPECT_LE((at_corner.pose - corners[i]).norm(), 1e-12);
    EXPECT_LE(at_corner.velocity.norm(), 1e-11);
    EXPECT_LE(at_corner.acceleration.norm(), 1e-9);
    const PlatformReference half_way = circuit.evaluate((static_cast<double>(i) + 0.5) * leg);
    EXPECT_LE((half_way.pose - (corners[i] + corners[(i + 1) % 4]) / 2).norm(), 1e-12);
    EXPECT_NEAR(half_way.velocity.norm(), 1.5, 1e-12);
  }
}

TEST(WaypointCircuit, KeepsOrientationSpeedAndAccelerationOnTheSquare) {
  const auto circuit = square(1);
  double fastest = 0.0, strongest = 0.0;
  for (int k = 0; k <= 10'000; ++k) {
    const PlatformReference m = circuit.evaluate(k * circuit.duration() / 10'000);
    ASSERT_EQ(m.pose(2), 0.1);
    ASSERT_EQ(m.velocity(2), 0.0);
    fastest = std::max(fastest, m.velocity.norm());
    strongest = std::max(strongest, m.acceleration.norm());
  }
  EXPECT_NEAR(fastest, 1.5, 1.5e-9);
  EXPECT_NEAR(strongest, 12.0, 12e-9);
}

TEST(WaypointCircuit, RepeatsItsLapsAndThenRestsAtTheStart) {
  const auto one = square(1), three = square(3);
  EXPECT_DOUBLE_EQ(three.duration(), 3 * one.duration());
  for (int k = 1; k < 1000; ++k) {
    const double time = k * three.duration() / 1000;
    const double in_lap = std::fmod(time, three.lap_duration());
    EXPECT_LE((three.evaluate(time).pose - one.evaluate(in_lap).pose).norm(), 1e-12);
    EXPECT_FALSE(three.evaluate(time).finished);
  }
  for (const double time : {three.duration(), three.duration() + 5}) {
    EXPECT_TRUE(three.evaluate(time).valid);
    EXPECT_TRUE(three.evaluate(time).finished);
    EXPECT_EQ(three.evaluate(time).pose, three.evaluate(0.0).pose);
    EXPECT_EQ(three.evaluate(time).velocity, Vector3d(0, 0, 0));
  }
  EXPECT_FALSE(three.evaluate(-1.0).finished);
}

/// As in the law of synchronised motions: a jump would exceed what the limits allow over a step.
TEST(WaypointCircuit, IsSmoothAndKeepsBothLimitsOnRandomTours) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  const double margin = 1 + 1e-9;
  for (int i = 0; i < 1000; ++i) {
    std::vector<Configuration> tour(2 + static_cast<std::size_t>(i) % 7);
    for (auto& pose : tour) pose = Vector3d(normal(generator), normal(generator), normal(generator));
    const auto circuit = WaypointCircuit::plan(plane, tour, limits);
    ASSERT_TRUE(circuit.valid());
    const double h = circuit.duration() / 500;
    for (int k = 0; k < 500; ++k) {
      const PlatformReference a = circuit.evaluate(k * h), b = circuit.evaluate((k + 1) * h);
      ASSERT_LE(b.velocity.head(2).norm(), limits.translation.velocity * margin);
      ASSERT_LE(std::abs(b.velocity(2)), limits.rotation.velocity * margin);
      ASSERT_LE(b.acceleration.head(2).norm(), limits.translation.acceleration * margin);
      ASSERT_LE(std::abs(b.acceleration(2)), limits.rotation.acceleration * margin);
      ASSERT_LE((b.acceleration - a.acceleration).head(2).norm(), limits.translation.jerk * h * margin);
      ASSERT_LE((b.velocity - a.velocity - h / 2 * (a.acceleration + b.acceleration)).head(2).norm(),
                limits.translation.jerk * h * h / 4 + 1e-12);
      ASSERT_LE((plane.difference(b.pose, a.pose) - h / 2 * (a.velocity + b.velocity)).head(2).norm(),
                limits.translation.acceleration * h * h / 4 + 1e-12);
    }
  }
}

TEST(WaypointCircuit, TurnsWhileItMovesAndArrivesTogether) {
  const std::vector<Configuration> tour{Vector3d(0, 0, 0), Vector3d(0.4, 0, 0.8), Vector3d(0.4, 0, 0)};
  const auto circuit = WaypointCircuit::plan(plane, tour, limits);
  ASSERT_TRUE(circuit.valid());
  const double leg = 1.5 / 12.0 + 12.0 / 1200.0 + 0.4 / 1.5;  // here the translation takes longer
  for (int k = 0; k < 100; ++k) {
    const PlatformReference m = circuit.evaluate(k * leg / 100);
    EXPECT_NEAR(m.pose(2), 2 * m.pose(0), 1e-12);
  }
}

TEST(WaypointCircuit, TakesNoTimeBetweenEqualPoses) {
  const std::vector<Configuration> tour{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 0, 0)};
  const std::vector<Configuration> without{Vector3d(0, 0, 0), Vector3d(1, 0, 0)};
  const auto circuit = WaypointCircuit::plan(plane, tour, limits);
  ASSERT_TRUE(circuit.valid());
  EXPECT_DOUBLE_EQ(circuit.duration(), WaypointCircuit::plan(plane, without, limits).duration());
  const std::vector<Configuration> nowhere{Vector3d(1, 2, 3), Vector3d(1, 2, 3)};
  const auto standing = WaypointCircuit::plan(plane, nowhere, limits, 5);
  EXPECT_TRUE(standing.valid());
  EXPECT_TRUE(standing.evaluate(0.0).finished);
  EXPECT_EQ(standing.evaluate(0.0).pose, Vector3d(1, 2, 3));
}

TEST(WaypointCircuit, RestsAndIsNotValidOnBadInput) {
  const Configuration first = Vector3d(1, 2, 3);
  const std::vector<Configuration> tour{first, Vector3d(4, 5, 6)};
  const std::vector<Configuration> too_few{first}, too_many(WaypointCircuit::max_waypoints + 1, first);
  const std::vector<Configuration> mixed{first, Vector2d(4, 5)}, unknown{first, Vector3d(4, not_a_number, 6)};
  PoseLimits no_jerk = limits;
  no_jerk.translation.jerk = 0.0;
  for (const WaypointCircuit& circuit :
       {WaypointCircuit::plan(plane, too_few, limits), WaypointCircuit::plan(plane, too_many, limits),
        WaypointCircuit::plan(plane, mixed, limits), WaypointCircuit::plan(plane, unknown, limits),
        WaypointCircuit::plan(ConfigurationSpace::Kind::spatial_pose, tour, limits),
        WaypointCircuit::plan(plane, tour, no_jerk), WaypointCircuit::plan(plane, tour, limits, 0)}) {
    EXPECT_FALSE(circuit.valid());
    EXPECT_EQ(circuit.duration(), 0.0);
    EXPECT_FALSE(circuit.evaluate(0.1).valid);
    EXPECT_EQ(circuit.evaluate(0.1).pose, first);
    EXPECT_EQ(circuit.evaluate(0.1).velocity.norm(), 0.0);
  }
  EXPECT_FALSE(WaypointCircuit::plan(plane, {}, limits).evaluate(0.0).valid);
  EXPECT_FALSE(square(1).evaluate(not_a_number).valid);
  EXPECT_FALSE(WaypointCircuit{}.evaluate(0.0).valid);
  EXPECT_EQ(WaypointCircuit{}.evaluate(0.0).velocity.size(), 0) << "of no space";
}

TEST(WaypointCircuit, NeedsNoHeap) {
  const Configuration centre = Vector3d(0, 0, 0);
  const test::AllocationCounter counter;
  const auto circuit = WaypointCircuit::plan(plane, square_corners(centre, side), limits, 10);
  const PlatformReference m = circuit.evaluate(3.0);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(m.valid);
}

}  // namespace
}  // namespace flinch
