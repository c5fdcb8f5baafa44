#include "systems/robot/constraint_tasks.h"
#include "systems/robot/decompositions.h"

#include <numbers>

#include "systems/robot/link_segments.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/systems/robot/mechanism_laws.h"

namespace flinch::test {
namespace {

NearbyPlaces nearby_of(const Mechanism& mechanism, const Kinematics& k) {
  NearbyPlaces nearby;
  evaluate_nearby(mechanism, k, nearby);
  return nearby;
}

class ConstraintTaskLaws : public MechanismLaws {
 protected:
  template <class TaskAt>
  PlatformVector gradient_by_differences(const Configuration& pose, const TaskAt& task_at,
                                         double step = 1e-4) const {
    PlatformVector gradient(n);
    for (int axis = 0; axis < n; ++axis) {
      gradient[axis] = derivative(
          [&](double h) { return task_at(kinematics_at(space.plus(pose, h * unit(axis)), 0.0 * unit(0))); },
          step);
    }
    return gradient;
  }
  double sigma_kappa(const Kinematics& k) const { return k.sigma_kappa; }
  double sigma_sc(const Kinematics& k) const { return self_collision_distance(robot, k); }

  // Whether one pair of links, or ends of links that all keep their distance, is nearest all around a pose.
  bool is_smooth_around(const Configuration& pose, double distance) const {
    const auto nearest = [&](const PlatformVector& xi) {
      return nearest_links(robot, kinematics_at(space.plus(pose, xi), 0.0 * unit(0)), 2e-3);
    };
    const NearestLinksList here = nearest(PlatformVector::Zero(n));
    for (int i = 0; i < here.count; ++i) {
      const SegmentDistance& links = here.links[static_cast<std::size_t>(i)].segments;
      if (links.distance < 1e-3) return false;
      if (here.count > 1 && !(is_end(links.fraction_a) && is_end(links.fraction_b))) return false;
    }
    for (int axis = 0; axis < n; ++axis) {
      for (const double h : {-distance, distance}) {
        if (!are_the_same(here, nearest(h * unit(axis)))) return false;
      }
    }
    return true;
  }
  static bool is_end(double fraction) { return fraction <= 0.0 || fraction >= 1.0; }
  static bool are_the_same(const NearestLinksList& a, const NearestLinksList& b) {
    bool same = a.count == b.count;
    for (int i = 0; same && i < a.count; ++i) {
      const NearestLinks& p = a.links[static_cast<std::size_t>(i)];
      const NearestLinks& q = b.links[static_cast<std::size_t>(i)];
      same = p.bodies.a == q.bodies.a && p.bodies.b == q.bodies.b &&
             is_end(p.segments.fraction_a) == is_end(q.segments.fraction_a) &&
             is_end(p.segments.fraction_b) == is_end(q.segments.fraction_b);
    }
    return same;
  }
};
FLINCH_FOR_ALL_MECHANISMS(ConstraintTaskLaws);

TEST_P(ConstraintTaskLaws, GradientOfTheConditionNumberAgreesWithDifferences) {
  Residual residual("gradient of sigma_kappa against differences, relative", 1e-6);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const Task task = condition_number_task(robot, k, nearby_of(robot, k));
    ASSERT_TRUE(task.valid);
    EXPECT_EQ(task.sigma[0], k.sigma_kappa);
    // Near a tie of singular values the gradient turns within the step.
    PlatformMatrix scaled = k.J_qa_x;
    scaled.rightCols(space.rotations()) /= robot.description().characteristic_length;
    const Eigen::JacobiSVD<PlatformMatrix> svd(scaled);
    const PlatformVector s = svd.singularValues();
    bool tie = false;
    for (int i = 0; i + 1 < n; ++i) tie = tie || s[i] - s[i + 1] < 0.02 * s[i];
    if (tie) continue;
    const PlatformVector expected =
        gradient_by_differences(state.pose, [](const Kinematics& at) { return at.sigma_kappa; });
    compare(residual, PlatformVector(task.J.transpose()), expected);
  }
}

TEST_P(ConstraintTaskLaws, SmoothConditionNumberBoundsTheConditionNumberAndHasItsGradient) {
  Residual residual("gradient of ln kappa_8 against differences", 1e-6);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const Task task = smooth_condition_number_task(robot, k, nearby_of(robot, k));
    ASSERT_TRUE(task.valid);
    EXPECT_GE(task.sigma[0], std::log(k.sigma_kappa) - 1e-9);
    EXPECT_LE(task.sigma[0], std::log(k.sigma_kappa) + std::log(std::max(n - 1, 1)) / 16.0 + 1e-9);
    const PlatformVector expected = gradient_by_differences(state.pose, [this](const Kinematics& at) {
      return smooth_condition_number_task(robot, at, NearbyPlaces()).sigma[0];
    });
    compare(residual, PlatformVector(task.J.transpose()), expected);
  }
}

TEST_P(ConstraintTaskLaws, DriftIsTheSecondDerivativeAlongTheMotion) {
  Residual smooth("drift of ln kappa_8 against differences of its rate, relative", 2e-3);
  for (const MotionState& state : states) {
    const auto task_after = [&](double time) {
      const Kinematics k = kinematics_after(state, time);
      return smooth_condition_number_task(robot, k, nearby_of(robot, k));
    };
    const double drift =
        derivative([&](double time) { return task_after(time).rate(state.velocity)[0]; }, 1e-4);
    const double scale = std::max(std::abs(drift), state.velocity.squaredNorm());
    smooth.add((task_after(0.0).drift[0] - drift) / scale);
  }
}

TEST_P(ConstraintTaskLaws, GradientOfTheSelfCollisionDistanceAgreesWithDifferences) {
  Residual residual("gradient of sigma_sc against differences", 1e-6);
  Residual drifts("drift of sigma_sc against differences of its rate, relative", 1e-3);
  for (const MotionState& state : states) {
    const Kinematics k = kinematics_at(state.pose, state.velocity);
    const Task task = self_collision_task(robot, k, nearby_of(robot, k));
    ASSERT_TRUE(task.valid);
    EXPECT_EQ(task.sigma[0], self_collision_distance(robot, k));
    if (task.sigma[0] < 1e-9) {
      EXPECT_TRUE(task.J.isZero(0.0)) << "links that cross have no way apart";
      residual.add(0.0);
      drifts.add(0.0);
    }
    if (!is_smooth_around(state.pose, 2e-3)) continue;
    const PlatformVector expected =
        gradient_by_differences(state.pose, [this](const Kinematics& at) { return sigma_sc(at); });
    compare(residual, PlatformVector(task.J.transpose()), expected);
    const double drift = derivative(
        [&](double time) {
          const Kinematics at = kinematics_after(state, time);
          return self_collision_task(robot, at, NearbyPlaces()).rate(state.velocity)[0];
        },
        1e-4);
    const double scale = std::max(std::abs(drift), state.velocity.squaredNorm());
    drifts.add((task.drift[0] - drift) / scale);
  }
}

TEST_P(ConstraintTaskLaws, NothingOfThemAllocates) {
  const MotionState& state = states.front();
  const Kinematics k = kinematics_at(state.pose, state.velocity);
  NearbyPlaces nearby;
  const test::AllocationCounter counter;
  evaluate_nearby(robot, k, nearby);
  const bool valid = condition_number_task(robot, k, nearby).valid &&
                     smooth_condition_number_task(robot, k, nearby).valid &&
                     self_collision_task(robot, k, nearby).valid;
  EXPECT_EQ(counter.count(), 0);
  EXPECT_TRUE(valid);
}

TEST_P(ConstraintTaskLaws, OutOfReachNoneIsValid) {
  const Kinematics nowhere = kinematics_at(Configuration(), PlatformVector());
  const NearbyPlaces nearby = nearby_of(robot, nowhere);
  EXPECT_EQ(nearby.step, 0.0);
  EXPECT_FALSE(condition_number_task(robot, nowhere, nearby).valid);
  EXPECT_FALSE(smooth_condition_number_task(robot, nowhere, nearby).valid);
  EXPECT_FALSE(self_collision_task(robot, nowhere, nearby).valid);
}

// ---------------------------------------------------------------- where there is no gradient

class PlanarConstraints : public ::testing::Test {
 protected:
  Kinematics at(double x, double y, double phi) const {
    Kinematics k;
    robot.kinematics(Eigen::Vector3d(x, y, phi), PlatformVector::Zero(3), k);
    return k;
  }
  Task self_collision(const Kinematics& k) const { return self_collision_task(robot, k, NearbyPlaces()); }

  PlanarRrr robot{rig_robot(RigGeometry::nominal, RigFriction::none)};
};

TEST_F(PlanarConstraints, OnThePlateauTheSelfCollisionDistanceHasNoGradientAndNoDrift) {
  Kinematics k;
  robot.kinematics(Eigen::Vector3d(0.02, -0.01, 0.1), Eigen::Vector3d(0.8, -0.5, 2.0), k);
  const Task task = self_collision_task(robot, k, nearby_of(robot, k));
  EXPECT_NEAR(task.sigma[0], 0.107 * std::numbers::sqrt3, 1e-12);
  EXPECT_LT(task.J.lpNorm<Eigen::Infinity>(), 1e-14);
  EXPECT_NEAR(task.drift[0], 0.0, 1e-7);  // rounding of 0.19 m over the square of the step
}

// Turned about its centre the nominal robot has threefold symmetry: three pairs of links are equally near.
TEST_F(PlanarConstraints, AtATieTheGradientIsTheSteepestAscentOfTheSmallestDistance) {
  const Kinematics k = at(0.0, 0.0, -0.6);
  ASSERT_GE(nearest_links(robot, k, 1e-9).count, 3);
  const Task task = self_collision(k);
  ASSERT_LT(task.sigma[0], 0.18);
  const PlatformVector gradient = task.J.transpose();
  ASSERT_GT(gradient.norm(), 1e-3);
  // It grows by |g| along g, and along no other direction by more.
  const auto slope = [&](const PlatformVector& direction) {
    const double h = 1e-6;
    const PlatformVector xi = h * direction;
    return (self_collision_distance(robot, at(xi[0], xi[1], -0.6 + xi[2])) - task.sigma[0]) / h;
  };
  EXPECT_NEAR(slope(gradient.normalized()), gradient.norm(), 1e-5);
  for (int i = 0; i < 50; ++i) {
    const PlatformVector other = Eigen::Vector3d::Random().normalized();
    EXPECT_LE(slope(other), gradient.norm() + 1e-5);
  }
}

TEST_F(PlanarConstraints, BetweenTwoPairsThatMoveApartTheGradientLiesBetweenTheirs) {
  const Kinematics k = at(0.0, 0.0, -0.6);
  const Task task = self_collision(k);
  EXPECT_NEAR(task.J(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(task.J(0, 1), 0.0, 1e-9);
}

// At the centre the two larger singular values are equal.
TEST_F(PlanarConstraints, AtATieOfSingularValuesTheGradientLiesBetweenTheOneSidedSlopes) {
  const Kinematics k = at(0.0, 0.0, 0.3);
  const Task task = condition_number_task(robot, k, NearbyPlaces());
  ASSERT_TRUE(task.valid);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(axis);
    const double h = 1e-6;
    const double ahead = (at(h * e[0], h * e[1], 0.3 + h * e[2]).sigma_kappa - k.sigma_kappa) / h;
    const double behind = (k.sigma_kappa - at(-h * e[0], -h * e[1], 0.3 - h * e[2]).sigma_kappa) / h;
    EXPECT_LE(task.J(0, axis), std::max(ahead, behind) + 1e-3) << axis;
    EXPECT_GE(task.J(0, axis), std::min(ahead, behind) - 1e-3) << axis;
  }
}

}  // namespace
}  // namespace flinch::test
