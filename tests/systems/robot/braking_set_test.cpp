#include "systems/robot/braking_set.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "systems/robot/link_segments.h"
#include "tests/support/allocations.h"
#include "tests/support/planar_rig.h"

namespace flinch {
namespace {

PoseConstraints tight_limits() {
  PoseConstraints limits;
  limits.max_condition_number = 15.0;
  limits.workspace.min_self_collision_distance = 0.17;
  return limits;
}

/// A posture with its model.
struct State {
  State(const Mechanism& robot, const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) {
    robot.kinematics(pose, velocity, at);
    robot.dynamics(at, dynamics);
  }
  Kinematics at;
  Dynamics dynamics;
};

double largest_torque(const State& state, double duration) {
  const PlatformVector wrench = state.dynamics.M_x * (-state.at.velocity / duration) +
                                state.dynamics.C_x * state.at.velocity + state.dynamics.g_x +
                                state.dynamics.F_fr_x;
  return (state.at.J_x_qa.transpose() * wrench).lpNorm<Eigen::Infinity>();
}

TEST(AStraightStop, IsAsShortAsTheDrivesAllow) {
  const auto robot = test::planar_rig();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 500; ++trial) {
    const State state(*robot, {0.06 * any(random), 0.06 * any(random), 0.15 * any(random)},
                      {1.5 * any(random), 1.5 * any(random), 4.0 * any(random)});
    const StraightStop stop = straight_stop(*robot, state.at, state.dynamics, {}, 70.0);
    ASSERT_TRUE(stop.is_possible());
    EXPECT_NEAR(largest_torque(state, stop.duration), 70.0, 1e-6);
    EXPECT_GT(largest_torque(state, 0.9 * stop.duration), 70.0);
  }
}

// The way is a parabola: its points, found by stepping the motion with its constant deceleration.
TEST(AStraightStop, StaysInsideWhereEveryPoseOnItsWayDoes) {
  const auto robot = test::planar_rig();
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const PoseConstraints limits = tight_limits();
  int inside = 0, outside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const State state(*robot, {0.16 * any(random), 0.16 * any(random), 0.4 * any(random)},
                      {2.0 * any(random), 2.0 * any(random), 6.0 * any(random)});
    const StraightStop stop = straight_stop(*robot, state.at, state.dynamics, limits, 70.0);
    constexpr int steps = 2000;
    Eigen::Vector3d pose = state.at.pose, velocity = state.at.velocity;
    double sigma_kappa = 0.0, sigma_sc = 1.0;
    for (int k = 0; k <= steps; ++k) {
      Kinematics at;
      robot->kinematics(pose, PlatformVector::Zero(3), at);
      sigma_kappa = std::max(sigma_kappa, at.sigma_kappa);
      sigma_sc = std::min(sigma_sc, self_collision_distance(*robot, at));
      const Eigen::Vector3d next = state.at.velocity * (1.0 - static_cast<double>(k + 1) / steps);
      pose += 0.5 * stop.duration / steps * (velocity + next);
      velocity = next;
    }
    // What all of 2000 places keep, the ten that are asked keep too; what few of 2000 exceed, they may miss.
    const bool clearly_inside = sigma_kappa < 15.0 - 1e-6 && sigma_sc > 0.17 + 1e-9;
    const bool clearly_outside = sigma_kappa > 15.5 || sigma_sc < 0.168;
    if (clearly_inside || clearly_outside) {
      EXPECT_EQ(stop.stays_inside, clearly_inside) << sigma_kappa << " " << sigma_sc;
    }
    inside += clearly_inside ? 1 : 0;
    outside += clearly_outside ? 1 : 0;
  }
  EXPECT_GT(inside, 40);
  EXPECT_GT(outside, 40);
}

TEST(AStraightStop, OfARobotAtRestIsOver) {
  const auto robot = test::planar_rig();
  const State state(*robot, {0, 0, 0}, {0, 0, 0});
  const StraightStop stop = straight_stop(*robot, state.at, state.dynamics, tight_limits(), 70.0);
  EXPECT_TRUE(stop.is_possible() && stop.stays_inside);
  EXPECT_EQ(stop.duration, 0.0);
}

TEST(AStraightStop, IsNotPossibleWithoutTorquesOrWithoutAModel) {
  const auto robot = test::planar_rig();
  const State state(*robot, {0, 0, 0}, {2.0, 0, 0});
  const StraightStop stop = straight_stop(*robot, state.at, state.dynamics, tight_limits(), 1e-6);
  EXPECT_FALSE(stop.is_possible() || stop.stays_inside);
  EXPECT_EQ(stop.duration, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(straight_stop(*robot, Kinematics(), state.dynamics, tight_limits(), 70.0).is_possible());
  EXPECT_FALSE(straight_stop(*robot, state.at, Dynamics(), tight_limits(), 70.0).is_possible());
}

TEST(AStraightStop, DoesNotAllocate) {
  const auto robot = test::planar_rig();
  const State state(*robot, {0.02, 0, 0.1}, {1.0, 0.2, 0.5});
  const test::AllocationCounter counter;
  straight_stop(*robot, state.at, state.dynamics, tight_limits(), 70.0);
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace flinch
