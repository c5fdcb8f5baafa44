// Laws of the jerk-limited profile on seeded random starts, goals and limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "systems/motion/jerk_limited_profile.h"

namespace flinch {
namespace {

constexpr int cases = 100'000;

struct Case {
  ScalarMotion start;
  double goal;
  MotionLimits limits;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(generator_); }

  /// From robots that creep to robots that throw, with short to long times to gain speed and acceleration.
  MotionLimits limits() {
    const double velocity = logarithmic(0.05, 10);
    const double acceleration = velocity / logarithmic(0.02, 1);
    return {velocity, acceleration, acceleration / logarithmic(0.001, 0.3)};
  }
  double distance() { return (below(2) == 0 ? -1 : 1) * logarithmic(1e-9, 10); }

  /// At rest, moving inside the limits, and moving and accelerating as much as half beyond them.
  Case any() {
    const MotionLimits limits = this->limits();
    ScalarMotion start{uniform(-1, 1), 0.0, 0.0, 0.0};
    const int kind = below(4);
    if (kind > 0) start.velocity = (kind == 3 ? 1.5 : 1) * uniform(-1, 1) * limits.velocity;
    if (below(2) == 0 && kind > 0)
      start.acceleration = (kind == 3 ? 1.5 : 1) * uniform(-1, 1) * limits.acceleration;
    return {start, start.position + distance(), limits};
  }
  Case from_rest() {
    const ScalarMotion start{uniform(-1, 1), 0.0, 0.0, 0.0};
    return {start, start.position + distance(), limits()};
  }

 private:
  std::mt19937_64 generator_;
};

JerkLimitedProfile plan(const Case& c) { return JerkLimitedProfile::plan(c.start, c.goal, c.limits); }

ScalarMotion after(const ScalarMotion& m, double jerk, double t) {
  return {m.position + m.velocity * t + m.acceleration * t * t / 2 + jerk * t * t * t / 6,
          m.velocity + m.acceleration * t + jerk * t * t / 2, m.acceleration + jerk * t, jerk};
}

/// Times at which velocity or acceleration may be extreme: borders of phases, and zeros of the acceleration.
std::vector<double> times_to_look_at(const JerkLimitedProfile& profile) {
  std::vector<double> times;
  for (const auto& phase : profile.phases()) {
    times.push_back(phase.begin);
    if (phase.at_begin.jerk != 0)
      times.push_back(phase.begin - phase.at_begin.acceleration / phase.at_begin.jerk);
  }
  times.push_back(std::nextafter(profile.duration(), 0.0));
  std::erase_if(times, [&](double t) { return t < 0 || t >= profile.duration(); });
  std::sort(times.begin(), times.end());
  return times;
}

/// By how much the time to a goal may change when rounding moves where the profile comes to rest: a motion
/// over the distance d takes 4 cbrt(d / 2 j) however small d is.
double time_of_rounding(const Case& c, const JerkLimitedProfile& profile) {
  double farthest = std::abs(c.start.position);
  for (const auto& phase : profile.phases()) farthest = std::max(farthest, std::abs(phase.at_begin.position));
  return 4 * std::cbrt(1e-14 * farthest / (2 * c.limits.jerk)) + 1e-12 * profile.duration();
}

TEST(JerkLimitedProfile, StartsAsGivenAndComesToRestAtTheGoal) {
  Draw draw(1);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.any();
    const JerkLimitedProfile profile = plan(c);
    ASSERT_TRUE(profile.valid()) << i;
    const ScalarMotion first = profile.evaluate(0.0);
    ASSERT_DOUBLE_EQ(first.position, c.start.position) << i;
    ASSERT_DOUBLE_EQ(first.velocity, c.start.velocity) << i;
    ASSERT_DOUBLE_EQ(first.acceleration, c.start.acceleration) << i;

    ASSERT_FALSE(profile.phases().empty()) << i;
    const auto& phase = profile.phases().back();
    const ScalarMotion last = after(phase.at_begin, phase.at_begin.jerk, profile.duration() - phase.begin);
    ASSERT_NEAR(last.position, c.goal, 1e-11) << i;
    ASSERT_NEAR(last.velocity, 0.0, 1e-9 * c.limits.velocity) << i;
    ASSERT_NEAR(last.acceleration, 0.0, 1e-9 * c.limits.acceleration) << i;
    const ScalarMotion held = profile.evaluate(profile.duration());
    ASSERT_EQ(held.position, c.goal) << i;
    ASSERT_EQ(held.velocity, 0.0) << i;
    ASSERT_EQ(held.acceleration, 0.0) << i;
    ASSERT_EQ(held.jerk, 0.0) << i;
  }
}

TEST(JerkLimitedProfile, IsContinuousInPositionVelocityAndAcceleration) {
  Draw draw(2);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.any();
    const JerkLimitedProfile profile = plan(c);
    const auto phases = profile.phases();
    for (std::size_t k = 0; k + 1 < phases.size(); ++k) {
      const ScalarMotion end =
          after(phases[k].at_begin, phases[k].at_begin.jerk, phases[k + 1].begin - phases[k].begin);
      ASSERT_NEAR(end.position, phases[k + 1].at_begin.position, 1e-9) << i;
      ASSERT_NEAR(end.velocity, phases[k + 1].at_begin.velocity, 1e-9 * c.limits.velocity) << i;
      ASSERT_NEAR(end.acceleration, phases[k + 1].at_begin.acceleration, 1e-9 * c.limits.acceleration) << i;
    }
  }
}

/// Simpson's rule, exact for the linear acceleration and quadratic velocity between borders, on what
/// `evaluate` says at thirds of every phase.
TEST(JerkLimitedProfile, IsTheIntegralOfItsJerk) {
  Draw draw(3);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.any();
    const JerkLimitedProfile profile = plan(c);
    const auto phases = profile.phases();
    ScalarMotion sum = c.start;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      const double end = k + 1 < phases.size() ? phases[k + 1].begin : profile.duration();
      const double h = (end - phases[k].begin) / 3;
      for (int third = 0; third < 3; ++third) {
        const double t = phases[k].begin + third * h;
        const double inside = std::nextafter(t + h, 0.0);
        const ScalarMotion a = profile.evaluate(t), b = profile.evaluate(t + h / 2),
                           d = profile.evaluate(inside);
        sum.position += h / 6 * (a.velocity + 4 * b.velocity + d.velocity);
        sum.velocity += h / 6 * (a.acceleration + 4 * b.acceleration + d.acceleration);
        sum.acceleration += h * b.jerk;
      }
    }
    ASSERT_NEAR(sum.position, c.goal, 1e-9) << i;
    ASSERT_NEAR(sum.velocity, 0.0, 1e-9 * c.limits.velocity) << i;
    ASSERT_NEAR(sum.acceleration, 0.0, 1e-9 * c.limits.acceleration) << i;
  }
}

/// The speed that a motion has or cannot avoid any more: it coasts on while its acceleration is taken away.
double inevitable_speed(const ScalarMotion& m, double jerk) {
  const double coasting = m.velocity + m.acceleration * std::abs(m.acceleration) / (2 * jerk);
  return std::max(std::abs(m.velocity), std::abs(coasting));
}

TEST(JerkLimitedProfile, KeepsItsLimitsOrReturnsToThemMonotonically) {
  Draw draw(4);
  const double margin = 1 + 1e-9;
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.any();
    const JerkLimitedProfile profile = plan(c);
    double speed = std::max(c.limits.velocity, inevitable_speed(c.start, c.limits.jerk));
    double acceleration = std::max(c.limits.acceleration, std::abs(c.start.acceleration));
    for (const double t : times_to_look_at(profile)) {
      const ScalarMotion m = profile.evaluate(t);
      ASSERT_LE(std::abs(m.jerk), c.limits.jerk * margin) << i;
      ASSERT_LE(std::abs(m.acceleration), acceleration * margin) << i;
      ASSERT_LE(inevitable_speed(m, c.limits.jerk), speed * margin) << i;
      acceleration = std::max(c.limits.acceleration, std::abs(m.acceleration));
      speed = std::max(c.limits.velocity, inevitable_speed(m, c.limits.jerk));
    }
  }
}

/// Textbook durations from rest to rest: with cruise, without, and without constant acceleration.
double rest_to_rest_duration(double distance, const MotionLimits& l) {
  const bool holds = l.velocity * l.jerk >= l.acceleration * l.acceleration;
  const double ramp =
      holds ? l.velocity / l.acceleration + l.acceleration / l.jerk : 2 * std::sqrt(l.velocity / l.jerk);
  if (distance >= l.velocity * ramp) return ramp + distance / l.velocity;
  const double swing = l.acceleration / l.jerk;
  if (distance >= 2 * l.acceleration * swing * swing) {
    return swing + std::sqrt(swing * swing + 4 * distance / l.acceleration);
  }
  return 4 * std::cbrt(distance / (2 * l.jerk));
}

TEST(JerkLimitedProfile, TakesTheDurationOfTheTextbookFromRestToRest) {
  Draw draw(5);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.from_rest();
    const double duration = rest_to_rest_duration(std::abs(c.goal - c.start.position), c.limits);
    ASSERT_NEAR(plan(c).duration(), duration, 1e-12 * duration) << i;
  }
}

TEST(JerkLimitedProfile, RunsTheSameBackwardsFromRestToRest) {
  Draw draw(6);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.from_rest();
    const JerkLimitedProfile there = plan(c);
    const JerkLimitedProfile back = JerkLimitedProfile::plan({c.goal, 0, 0, 0}, c.start.position, c.limits);
    ASSERT_NEAR(there.duration(), back.duration(), 1e-13 * there.duration()) << i;
    const double t = draw.uniform(0, 1) * there.duration();
    const ScalarMotion m = there.evaluate(t), r = back.evaluate(there.duration() - t);
    ASSERT_NEAR(m.position, r.position, 1e-11) << i;
    ASSERT_NEAR(m.velocity, -r.velocity, 1e-9 * c.limits.velocity) << i;
    ASSERT_NEAR(m.acceleration, r.acceleration, 1e-9 * c.limits.acceleration) << i;
  }
}

TEST(JerkLimitedProfile, IsMirroredExactlyByItsInput) {
  Draw draw(7);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.any();
    const ScalarMotion start{-c.start.position, -c.start.velocity, -c.start.acceleration, 0};
    const JerkLimitedProfile one = plan(c);
    const JerkLimitedProfile other = JerkLimitedProfile::plan(start, -c.goal, c.limits);
    ASSERT_EQ(one.duration(), other.duration()) << i;
    const double t = draw.uniform(0, 1) * one.duration();
    ASSERT_EQ(one.evaluate(t).position, -other.evaluate(t).position) << i;
  }
}

/// The rest of a shortest way is the shortest way from there: Bellman's principle. Sees every kind of start.
TEST(JerkLimitedProfile, ArrivesNoSoonerOrLaterWhenPlannedAgainOnTheWay) {
  Draw draw(8);
  for (int i = 0; i < cases; ++i) {
    const Case c = draw.any();
    const JerkLimitedProfile profile = plan(c);
    const double t = draw.uniform(0, 1) * profile.duration();
    const JerkLimitedProfile rest = JerkLimitedProfile::plan(profile.evaluate(t), c.goal, c.limits);
    ASSERT_NEAR(t + rest.duration(), profile.duration(), time_of_rounding(c, profile)) << i;
  }
}

/// A motion inside the limits made backwards from rest at 0, a border at a time, by up to `phases` random
/// jerks.
struct Witness {
  ScalarMotion start;
  double duration = 0.0;
  bool inside = true;

  Witness(Draw& draw, const MotionLimits& l, int phases) {
    const double scale = draw.logarithmic(0.01, 2) * (l.acceleration / l.jerk + l.velocity / l.acceleration);
    for (int k = 0; k < phases && inside; ++k) {
      const double jerk = l.jerk * (draw.below(3) - 1);
      const double time = draw.uniform(0, scale);
      const double turn = jerk == 0 ? 0 : start.acceleration / jerk;  // back to where the velocity is extreme
      if (turn > 0 && turn < time) inside = std::abs(after(start, jerk, -turn).velocity) <= l.velocity;
      start = after(start, jerk, -time);
      inside =
          inside && std::abs(start.velocity) <= l.velocity && std::abs(start.acceleration) <= l.acceleration;
      duration += time;
    }
  }
};

TEST(JerkLimitedProfile, IsNoSlowerThanAnyOtherMotionInsideTheLimits) {
  Draw draw(9);
  int tried = 0, as_fast = 0;
  while (tried < cases) {
    const MotionLimits limits = draw.limits();
    const Witness witness(draw, limits, 1 + draw.below(5));
    if (!witness.inside) continue;
    const Case c{witness.start, 0.0, limits};
    const JerkLimitedProfile profile = plan(c);
    ASSERT_LE(profile.duration(), witness.duration + time_of_rounding(c, profile)) << tried;
    if (profile.duration() > (1 - 1e-9) * witness.duration) ++as_fast;
    ++tried;
  }
  EXPECT_GT(as_fast, cases / 10);  // some witnesses are optimal themselves, so the bound is sharp
}

}  // namespace
}  // namespace flinch
