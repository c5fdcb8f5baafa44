#include "systems/robot/motion_barriers.h"

#include <cmath>
#include <numbers>

#include "systems/robot/link_segments.h"
#include "tests/support/allocations.h"
#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Limits of every kind.
PoseConstraints limits_of_every_kind() {
  PoseConstraints limits;
  limits.workspace.max_distance = 10.0;
  limits.workspace.max_rotation = 100.0 * degree;
  limits.workspace.min_abs_det_A = 1e-3;
  limits.workspace.min_abs_det_B = 1e-3;
  limits.workspace.min_self_collision_distance = 0.11;
  limits.workspace.min_active = -3.0;
  limits.workspace.max_active = 3.0;
  limits.max_condition_number = 1e3;
  return limits;
}

class MotionBarrierLaws : public MechanismLaws {
 protected:
  BarrierList barriers_at(const Kinematics& k, const LimitMargins& margins = {}) const {
    BarrierList list;
    evaluate_barriers(robot, k, limits_of_every_kind(), margins, list);
    return list;
  }
  /// Barriers are evaluated some ten thousand times in a test.
  std::vector<MotionState> some_states() const { return {states.begin(), states.begin() + 40}; }
  BarrierList barriers_after(const MotionState& state, double time) const {
    return barriers_at(kinematics_after(state, time));
  }
};
FLINCH_FOR_ALL_MECHANISMS(MotionBarrierLaws);

/// sigma_sc by the distance of links has kinks; tests of its task are elsewhere.
bool has_kinks(const Barrier& barrier, const Mechanism& robot, const Kinematics& k) {
  return barrier.kind == BarrierKind::self_collision && robot.self_collision_tasks(k, 0.11).count == 0;
}

TEST_P(MotionBarrierLaws, GradientsAreThoseOfTheRoom) {
  Residual residual("gradient of h against differences, relative", 2e-6);
  for (const MotionState& state : some_states()) {
    const BarrierList list = barriers_at(kinematics_at(state.pose, state.velocity));
    ASSERT_TRUE(list.valid);
    for (int i = 0; i < list.count; ++i) {
      if (has_kinks(list[i], robot, kinematics_at(state.pose, state.velocity))) continue;
      PlatformVector expected(n);
      for (int axis = 0; axis < n; ++axis) {
        expected[axis] = derivative(
            [&](double h) {
              const auto moved = kinematics_at(space.plus(state.pose, h * unit(axis)), state.velocity);
              return barriers_at(moved)[i].room;
            },
            1e-4);
      }
      compare(residual, list[i].gradient, expected);
    }
  }
}

TEST_P(MotionBarrierLaws, DriftIsWhatTheRateOfTheRoomDoesByItself) {
  Residual residual("drift of h against differences of its rate, relative", 5e-3);
  for (const MotionState& state : some_states()) {
    const BarrierList list = barriers_after(state, 0.0);
    for (int i = 0; i < list.count; ++i) {
      if (has_kinks(list[i], robot, kinematics_at(state.pose, state.velocity))) continue;
      const double expected = derivative(
          [&](double time) { return barriers_after(state, time)[i].gradient.dot(state.velocity); }, 1e-4);
      residual.add((list[i].drift - expected) / std::max(1.0, std::abs(expected)));
    }
  }
}

TEST_P(MotionBarrierLaws, LimitsThatAllowEverythingHaveNoBarrier) {
  BarrierList list;
  evaluate_barriers(robot, kinematics_at(robot.home_pose(), PlatformVector::Zero(n)), {}, {}, list);
  EXPECT_TRUE(list.valid);
  EXPECT_EQ(list.count, 0);
}

TEST_P(MotionBarrierLaws, MarginsOnlyTakeRoom) {
  const LimitMargins none{.condition_number = 0, .angle = 0, .distance = 0, .share = 0, .range = 0};
  for (const MotionState& state : some_states()) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const BarrierList with = barriers_at(k), without = barriers_at(k, none);
    ASSERT_EQ(with.count, without.count);
    for (int i = 0; i < with.count; ++i) {
      EXPECT_EQ(with[i].kind, without[i].kind);
      EXPECT_LT(with[i].room, without[i].room);
    }
  }
}

/// Without margins a barrier is positive exactly where the limit is kept, but for the bound on sigma_kappa,
/// which is on the safe side.
TEST_P(MotionBarrierLaws, RoomIsThatToTheLimit) {
  const LimitMargins none{.condition_number = 0, .angle = 0, .distance = 0, .share = 0, .range = 0};
  const PoseConstraints limits = limits_of_every_kind();
  for (const MotionState& state : some_states()) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const BarrierList list = barriers_at(k, none);
    double least_gap = 1.0, least_rotation = 2.0;
    for (int i = 0; i < list.count; ++i) {
      const double h = list[i].room;
      switch (list[i].kind) {
        case BarrierKind::condition_number:
          EXPECT_LE(std::exp(-h) * limits.max_condition_number, 1.17 * k.sigma_kappa);
          EXPECT_GE(std::exp(-h) * limits.max_condition_number, k.sigma_kappa * (1.0 - 1e-9));
          break;
        case BarrierKind::type_1_singularity:
          EXPECT_NEAR(std::exp(h) * 1e-3, std::abs(k.det_B), 1e-9 * std::abs(k.det_B));
          break;
        case BarrierKind::type_2_singularity:
          EXPECT_NEAR(std::exp(h) * 1e-3, std::abs(k.det_A), 1e-9 * std::abs(k.det_A));
          break;
        case BarrierKind::distance:
          EXPECT_NEAR(100.0 - 20.0 * h, state.pose.head(space.translations()).squaredNorm(), 1e-9);
          break;
        case BarrierKind::rotation:
          least_rotation = std::min(least_rotation, h);
          break;
        case BarrierKind::self_collision:
          least_gap = std::min(least_gap, h);
          break;
        case BarrierKind::drive_range:
          EXPECT_LE(h, 3.0 + k.joints.active.lpNorm<Eigen::Infinity>());
          break;
      }
    }
    EXPECT_EQ(least_gap < 0.0, self_collision_distance(robot, k) < 0.11);
    const double limit = 100.0 * degree, angle = space.rotation_angle(state.pose);
    const double room = space.rotations() == 1 ? limit - angle : 0.5 * (limit - angle * angle / limit);
    EXPECT_NEAR(least_rotation, space.rotations() == 0 ? 2.0 : room, 1e-9);
  }
}

TEST_P(MotionBarrierLaws, OutOfReachThereIsNoneThatIsValid) {
  EXPECT_FALSE(barriers_at(kinematics_at(Configuration(), PlatformVector())).valid);
}

TEST_P(MotionBarrierLaws, NeedNoHeap) {
  const Kinematics k = kinematics_at(states.front().pose, states.front().velocity);
  BarrierList list;
  const PoseConstraints limits = limits_of_every_kind();
  const test::AllocationCounter counter;
  evaluate_barriers(robot, k, limits, {}, list);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(list.count, 4);
}

}  // namespace
}  // namespace flinch::test
