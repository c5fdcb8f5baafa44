#include "systems/motion/synchronised_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flinch {
namespace {

/// Velocity across the line below this share of the whole is rounding.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

/// The unit vector of `direction`; zero if that is zero.
PlatformVector unit(const PlatformVector& direction) { return direction.stableNormalized(); }

/// What is left of a vector without its part along `e`: projected out twice, since once leaves rounding.
PlatformVector rejected(const PlatformVector& vector, const PlatformVector& e) {
  const PlatformVector once = vector - vector.dot(e) * e;
  return once - once.dot(e) * e;
}

bool is_usable(const PlatformVector& start, const PlatformVector& velocity, const PlatformVector& goal) {
  return start.size() > 0 && velocity.size() == start.size() && goal.size() == start.size() &&
         start.allFinite() && velocity.allFinite() && goal.allFinite();
}

}  // namespace

SynchronisedMotion SynchronisedMotion::plan(const PlatformVector& start, const PlatformVector& start_velocity,
                                            const PlatformVector& goal, const MotionLimits& limits) noexcept {
  SynchronisedMotion resting;
  resting.start_ = resting.goal_ = start;
  if (!is_usable(start, start_velocity, goal)) return resting;

  SynchronisedMotion motion = resting;
  motion.goal_ = goal;
  const PlatformVector displacement = goal - start;
  const double distance = displacement.stableNorm();
  motion.e_ = unit(distance > 0 ? displacement : start_velocity);
  const PlatformVector off_line = rejected(start_velocity, motion.e_);
  const bool on_line = off_line.stableNorm() <= rounding * start_velocity.stableNorm();
  motion.n_ = on_line ? PlatformVector::Zero(start.size()) : unit(off_line);
  motion.plan_profiles(distance, start_velocity.dot(motion.e_), on_line ? 0.0 : off_line.stableNorm(),
                       limits);
  return motion.valid_ ? motion : resting;
}

void SynchronisedMotion::plan_profiles(double distance, double along, double across,
                                       const MotionLimits& limits) noexcept {
  ScalarMotion handed_over{0.0, along, 0.0, 0.0};
  if (across > 0) {
    const double share = 1 / std::numbers::sqrt2;
    const double v_across = std::min(across, share * limits.velocity);
    const double v_along = std::sqrt(limits.velocity * limits.velocity - v_across * v_across);
    const double acceleration = share * limits.acceleration, jerk = share * limits.jerk;
    across_ = JerkLimitedProfile::plan({0.0, across, 0.0, 0.0}, 0.0, {v_across, acceleration, jerk});
    together_ = JerkLimitedProfile::plan(handed_over, distance, {v_along, acceleration, jerk});
    handover_ = across_.duration();
    handed_over = together_.evaluate(handover_);
  }
  alone_ = JerkLimitedProfile::plan(handed_over, distance, limits);
  valid_ = alone_.valid() && (across <= 0 || (across_.valid() && together_.valid()));
}

VectorMotion SynchronisedMotion::evaluate(double time) const noexcept {
  const PlatformVector rest = PlatformVector::Zero(goal_.size());
  const bool usable = valid_ && !std::isnan(time);
  if (!usable || time >= duration()) return {usable, goal_, rest, rest};
  const ScalarMotion s = time < handover_ ? together_.evaluate(time) : alone_.evaluate(time - handover_);
  const ScalarMotion c = across_.evaluate(time);
  return {true, start_ + s.position * e_ + c.position * n_, s.velocity * e_ + c.velocity * n_,
          s.acceleration * e_ + c.acceleration * n_};
}

}  // namespace flinch
