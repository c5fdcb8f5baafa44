// Laws of the synchronised straight-line motion on seeded random starts, goals and limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "systems/motion/synchronised_motion.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr int cases = 100'000;

struct Case {
  PlatformVector start, velocity, goal;
  MotionLimits limits;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  int size() { return std::uniform_int_distribution<int>(1, max_dof)(generator_); }
  PlatformVector vector(int size) {
    return PlatformVector::NullaryExpr(size,
                                       [this] { return std::normal_distribution<double>()(generator_); });
  }
  PlatformVector direction(int size) { return vector(size).normalized(); }

  /// At most `fastest` times the velocity limit, in any direction.
  Case any(double fastest) {
    Case c;
    const int size = this->size();
    c.limits.velocity = logarithmic(0.1, 5);
    c.limits.acceleration = c.limits.velocity / logarithmic(0.02, 0.5);
    c.limits.jerk = c.limits.acceleration / logarithmic(0.002, 0.1);
    c.start = vector(size);
    c.velocity = uniform(0, fastest) * c.limits.velocity * direction(size);
    c.goal = c.start + logarithmic(1e-6, 3) * direction(size);
    return c;
  }

  /// The same, but with hardly any velocity across the line.
  Case nearly_straight(double fastest) {
    Case c = any(fastest);
    const PlatformVector heading = uniform(-1, 1) * (c.goal - c.start).normalized() +
                                   logarithmic(1e-16, 1) * direction(static_cast<int>(c.start.size()));
    c.velocity = c.velocity.norm() * heading.normalized();
    return c;
  }

 private:
  std::mt19937_64 generator_;
};

SynchronisedMotion plan(const Case& c) {
  return SynchronisedMotion::plan(c.start, c.velocity, c.goal, c.limits);
}

TEST(SynchronisedMotion, StartsAsGivenAndComesToRestAtTheGoal) {
  Draw draw(1);
  for (int i = 0; i < cases; ++i) {
    const Case c = i % 2 == 0 ? draw.any(2) : draw.nearly_straight(2);
    const SynchronisedMotion motion = plan(c);
    ASSERT_TRUE(motion.valid()) << i;
    const VectorMotion first = motion.evaluate(0.0);
    ASSERT_LE((first.position - c.start).norm(), 1e-12) << i;
    ASSERT_LE((first.velocity - c.velocity).norm(), 1e-12 * c.limits.velocity) << i;
    ASSERT_LE(first.acceleration.norm(), 1e-12 * c.limits.acceleration) << i;

    const double end = std::nextafter(motion.duration(), 0.0), jump = 1e-9;
    const VectorMotion last = motion.evaluate(end);
    ASSERT_LE((last.position - c.goal).norm(), jump) << i;
    ASSERT_LE(last.velocity.norm(), jump * c.limits.velocity) << i;
    ASSERT_LE(last.acceleration.norm(), jump * c.limits.acceleration) << i;
    const VectorMotion held = motion.evaluate(motion.duration());
    ASSERT_EQ(held.position, c.goal) << i;
    ASSERT_EQ(held.velocity.norm(), 0.0) << i;
    ASSERT_EQ(held.acceleration.norm(), 0.0) << i;
  }
}

/// Over a step h the change of acceleration is at most j h; the trapezoidal rule is wrong by at most j h^2 /
/// 4 for the velocity and a h^2 / 4 for the position. A jump anywhere would exceed these.
void expect_smooth_step(const VectorMotion& from, const VectorMotion& to, double h,
                        const MotionLimits& limits) {
  const double rounding = 1e-12;
  EXPECT_LE((to.acceleration - from.acceleration).norm(),
            limits.jerk * h * (1 + 1e-9) + rounding * limits.acceleration);
  EXPECT_LE((to.velocity - from.velocity - h / 2 * (from.acceleration + to.acceleration)).norm(),
            limits.jerk * h * h / 4 + rounding * limits.velocity);
  EXPECT_LE((to.position - from.position - h / 2 * (from.velocity + to.velocity)).norm(),
            limits.acceleration * h * h / 4 + rounding);
}

TEST(SynchronisedMotion, KeepsTheNormsOfAccelerationAndJerkAndIsSmooth) {
  Draw draw(2);
  constexpr int steps = 20;
  for (int i = 0; i < cases; ++i) {
    const Case c = i % 2 == 0 ? draw.any(2) : draw.nearly_straight(2);
    const SynchronisedMotion motion = plan(c);
    const double h = motion.duration() / steps;
    VectorMotion from = motion.evaluate(0.0);
    for (int k = 1; k <= steps; ++k) {
      const VectorMotion to = motion.evaluate(k * h);
      ASSERT_LE(to.acceleration.norm(), c.limits.acceleration * (1 + 1e-9)) << i;
      expect_smooth_step(from, to, h, c.limits);
      const double t = draw.logarithmic(1e-9, 1) * motion.duration(), tiny = 1e-3 * std::min(t, h);
      const VectorMotion now = motion.evaluate(t);
      ASSERT_LE(now.acceleration.norm(), c.limits.acceleration * (1 + 1e-9)) << i;
      expect_smooth_step(now, motion.evaluate(t + tiny), tiny, c.limits);
      from = to;
    }
    ASSERT_FALSE(HasFailure()) << i;
  }
}

TEST(SynchronisedMotion, IsNeverFasterThanItsLimitOrItsStart) {
  Draw draw(3);
  constexpr int steps = 40;
  for (int i = 0; i < cases; ++i) {
    const double fastest_start = i % 4 < 2 ? 1 : 3;
    const Case c = i % 2 == 0 ? draw.any(fastest_start) : draw.nearly_straight(fastest_start);
    const SynchronisedMotion motion = plan(c);
    const double fastest = std::max(c.limits.velocity, c.velocity.norm()) * (1 + 1e-9);
    for (int k = 0; k < steps; ++k) {
      ASSERT_LE(motion.evaluate(k * motion.duration() / steps).velocity.norm(), fastest) << i;
    }
  }
}

TEST(SynchronisedMotion, StaysOnTheLineAndTakesTheScalarTimeIfItStartsOnTheLine) {
  Draw draw(4);
  for (int i = 0; i < cases; ++i) {
    Case c = draw.any(2);
    const double speed = draw.uniform(-2, 2) * c.limits.velocity;
    const PlatformVector line = (c.goal - c.start).normalized();
    c.velocity = speed * line;
    const SynchronisedMotion motion = plan(c);
    const auto scalar = JerkLimitedProfile::plan({0.0, speed, 0.0, 0.0}, (c.goal - c.start).norm(), c.limits);
    ASSERT_NEAR(motion.duration(), scalar.duration(), 1e-9 * scalar.duration()) << i;
    const VectorMotion m = motion.evaluate(draw.uniform(0, motion.duration()));
    const PlatformVector off = m.position - c.start;
    ASSERT_LE((off - off.dot(line) * line).norm(), 1e-12) << i;
  }
}

TEST(SynchronisedMotion, DoesNotDependOnTheChoiceOfCoordinates) {
  Draw draw(5);
  for (int i = 0; i < cases / 10; ++i) {
    const Case c = draw.any(2);
    const auto size = static_cast<int>(c.start.size());
    const Eigen::MatrixXd random =
        Eigen::MatrixXd::NullaryExpr(size, size, [&draw] { return draw.uniform(-1, 1); });
    const Eigen::MatrixXd Q = random.householderQr().householderQ();
    const SynchronisedMotion motion = plan(c);
    const SynchronisedMotion turned = plan({Q * c.start, Q * c.velocity, Q * c.goal, c.limits});
    const double t = draw.uniform(0, motion.duration());
    ASSERT_LE((Q * motion.evaluate(t).position - turned.evaluate(t).position).norm(), 1e-9) << i;
  }
}

TEST(SynchronisedMotion, BarelyChangesForBarelyAnyVelocityAcrossTheLine) {
  const PlatformVector start = PlatformVector::Zero(2), goal = Eigen::Vector2d(0.2, 0.0);
  const MotionLimits limits{1.0, 20.0, 2000.0};
  for (const double along : {-1.2, -0.3, 0.0, 0.7, 1.0, 1.3}) {
    const auto straight = SynchronisedMotion::plan(start, Eigen::Vector2d(along, 0.0), goal, limits);
    const auto slanted = SynchronisedMotion::plan(start, Eigen::Vector2d(along, 1e-12), goal, limits);
    EXPECT_NEAR(straight.duration(), slanted.duration(), 1e-6);
  }
}

}  // namespace
}  // namespace flinch
