#include "systems/motion/jerk_limited_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flinch {
namespace {

/// Most steps of the search: enough to bisect a bracket to the last bit, more than Newton's method needs.
constexpr int max_iterations = 64;

/// Positions closer than this share of their magnitude are the same.
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

/// Change of velocity that ends without acceleration, in the shortest time: full jerk one way, the
/// acceleration held at its limit if it gets there, full jerk the other way. Durations [s].
struct Ramp {
  double onset;
  double hold;
  double release;
};

bool is_finite(const ScalarMotion& motion) {
  return std::isfinite(motion.position) && std::isfinite(motion.velocity) &&
         std::isfinite(motion.acceleration);
}

ScalarMotion mirrored(const ScalarMotion& motion, double sign) {
  return {sign * motion.position, sign * motion.velocity, sign * motion.acceleration, sign * motion.jerk};
}

/// Motion after `time` at constant jerk.
ScalarMotion after(const ScalarMotion& from, double jerk, double time) {
  return {from.position + time * (from.velocity + time * (from.acceleration / 2 + time * jerk / 6)),
          from.velocity + time * (from.acceleration + time * jerk / 2), from.acceleration + time * jerk,
          jerk};
}

ScalarMotion after(const ScalarMotion& from, double jerk, const Ramp& ramp) {
  return after(after(after(from, jerk, ramp.onset), 0.0, ramp.hold), -jerk, ramp.release);
}

/// Velocity that is left when the acceleration is taken away at full jerk.
double coasting_velocity(const ScalarMotion& motion, double jerk) {
  return motion.velocity + motion.acceleration * std::abs(motion.acceleration) / (2 * jerk);
}

/// Ramp upwards to a velocity that is not below the coasting velocity.
Ramp ramp_up(const ScalarMotion& from, double velocity, const MotionLimits& limits) {
  const double a = from.acceleration;
  const double gain = velocity - from.velocity;
  const double peak = std::sqrt(std::max(0.0, limits.jerk * gain + a * a / 2));
  const double top = std::min(peak, limits.acceleration);
  const double held = gain - (top * top - a * a / 2) / limits.jerk;
  return {std::max(0.0, top - a) / limits.jerk, peak > top ? std::max(0.0, held) / top : 0.0,
          top / limits.jerk};
}

/// Ramp downwards to a velocity that is not above the coasting velocity.
Ramp ramp_down(const ScalarMotion& from, double velocity, const MotionLimits& limits) {
  return ramp_up(mirrored(from, -1.0), -velocity, limits);
}

/// Where braking at once comes to rest.
double stopping_position(const ScalarMotion& from, const MotionLimits& limits) {
  const bool forwards = coasting_velocity(from, limits.jerk) > 0;
  const double jerk = forwards ? -limits.jerk : limits.jerk;
  return after(from, jerk, forwards ? ramp_down(from, 0.0, limits) : ramp_up(from, 0.0, limits)).position;
}

/// Upward thrust, that is onset and hold of a ramp, and the braking down to rest after it.
class ThrustAndBrake {
 public:
  ThrustAndBrake(const ScalarMotion& from, const MotionLimits& limits)
      : from_(from),
        limits_(limits),
        onset_(std::max(0.0, limits.acceleration - from.acceleration) / limits.jerk) {}

  /// Motion at the end of a thrust of the given duration.
  ScalarMotion thrust(double duration) const {
    return after(after(from_, limits_.jerk, onset(duration)), 0.0, duration - onset(duration));
  }
  double onset(double duration) const { return std::min(duration, onset_); }

  /// Thrust after which braking comes to rest at `goal`, known to lie in [shortest, longest] and to be
  /// `excess` beyond the rest after the shortest: Newton's method inside a bracket, since the position of
  /// rest grows with the thrust.
  double solve(double goal, double excess, double shortest, double longest) const {
    longest = std::min(longest, bound(excess, shortest));
    double duration = longest;
    for (int i = 0; i < max_iterations; ++i) {
      const Rest rest = rest_after(duration);
      const double error = rest.position - goal;
      (error > 0 ? longest : shortest) = duration;
      const double newton = duration - error / rest.slope;
      const bool inside = newton >= shortest && newton <= longest;
      const double next = inside ? newton : shortest + (longest - shortest) / 2;
      const bool settled =
          std::abs(next - duration) <= rounding * duration || next == shortest || next == longest;
      duration = next;
      if (settled) break;
    }
    return duration;
  }

 private:
  /// Once the acceleration is positive the excess grows at least with 2 j t^3 while the onset lasts; from
  /// rest and without saturation exactly so.
  double bound(double excess, double shortest) const {
    const double still_braking = std::max(0.0, -thrust(shortest).acceleration) / limits_.jerk;
    const double duration = shortest + still_braking + std::cbrt(excess / (2 * limits_.jerk));
    return duration <= onset_ ? duration : std::numeric_limits<double>::infinity();
  }

  struct Rest {
    double position;
    double slope;  ///< derivative of the position by the duration of the thrust
  };

  /// Differentiating the sum of the phases gives the slope j fall (fall + 2 hold + rise), never negative,
  /// while the acceleration is still rising at the end of the thrust, and half of that when it is held.
  Rest rest_after(double duration) const {
    const ScalarMotion peak = thrust(duration);
    const Ramp brake = ramp_down(peak, 0.0, limits_);
    const double slope = limits_.jerk * brake.onset * (brake.onset + 2 * brake.hold + brake.release);
    return {after(peak, -limits_.jerk, brake).position, duration <= onset_ ? slope : slope / 2};
  }

  ScalarMotion from_;
  MotionLimits limits_;
  double onset_;
};

}  // namespace

bool can_be_planned_with(const MotionLimits& limits) noexcept {
  const auto positive = [](double limit) { return limit > 0 && std::isfinite(limit); };
  return positive(limits.velocity) && positive(limits.acceleration) && positive(limits.jerk);
}

JerkLimitedProfile JerkLimitedProfile::plan(const ScalarMotion& start, double goal,
                                            const MotionLimits& limits) noexcept {
  JerkLimitedProfile resting;
  resting.goal_ = start.position;
  if (!is_finite(start) || !std::isfinite(goal) || !can_be_planned_with(limits)) return resting;

  JerkLimitedProfile profile;
  profile.goal_ = goal;
  ScalarMotion now = start;
  profile.enter_acceleration_limit(now, limits);
  profile.enter_velocity_limit(now, limits);
  profile.reach_goal(now, limits);
  profile.valid_ = is_finite(now) && std::isfinite(profile.duration_);
  return profile.valid_ ? profile : resting;
}

ScalarMotion JerkLimitedProfile::evaluate(double time) const noexcept {
  if (count_ == 0 || time >= duration_) return {goal_, 0.0, 0.0, 0.0};
  int i = 0;
  while (i + 1 < count_ && time >= phases_[static_cast<std::size_t>(i + 1)].begin) ++i;
  const Phase& phase = phases_[static_cast<std::size_t>(i)];
  return after(phase.at_begin, phase.at_begin.jerk, std::max(time - phase.begin, 0.0));
}

std::span<const JerkLimitedProfile::Phase> JerkLimitedProfile::phases() const noexcept {
  return {phases_.data(), static_cast<std::size_t>(count_)};
}

void JerkLimitedProfile::append(ScalarMotion& now, double jerk, double time) noexcept {
  if (time <= 0) return;
  now.jerk = jerk;
  phases_[static_cast<std::size_t>(count_++)] = {duration_, now};
  duration_ += time;
  now = after(now, jerk, time);
}

void JerkLimitedProfile::enter_acceleration_limit(ScalarMotion& now, const MotionLimits& limits) noexcept {
  const double excess = std::abs(now.acceleration) - limits.acceleration;
  append(now, -std::copysign(limits.jerk, now.acceleration), excess / limits.jerk);
}

/// Onset and hold of the ramp to the velocity limit; its release is left to what follows.
void JerkLimitedProfile::enter_velocity_limit(ScalarMotion& now, const MotionLimits& limits) noexcept {
  const double coasting = coasting_velocity(now, limits.jerk);
  if (std::abs(coasting) <= limits.velocity) return;
  const double sign = coasting > 0 ? 1.0 : -1.0;
  const Ramp ramp = ramp_down(mirrored(now, sign), limits.velocity, limits);
  append(now, -sign * limits.jerk, ramp.onset);
  append(now, 0.0, ramp.hold);
}

void JerkLimitedProfile::reach_goal(ScalarMotion& now, const MotionLimits& limits) noexcept {
  const double stop = stopping_position(now, limits);
  const double sign = goal_ < stop ? -1.0 : 1.0;
  const double jerk = sign * limits.jerk;
  // Seen from here, looking in the direction of the thrust.
  const ScalarMotion from = mirrored({0.0, now.velocity, now.acceleration, 0.0}, sign);
  const double distance = sign * (goal_ - now.position);

  const Ramp to_cruise = ramp_up(from, limits.velocity, limits);
  const double spare = distance - stopping_position(after(from, limits.jerk, to_cruise), limits);
  if (spare >= 0) {
    append(now, jerk, to_cruise.onset);
    append(now, 0.0, to_cruise.hold);
    append(now, -jerk, to_cruise.release);
    now.acceleration = 0.0;  // exactly: over a long cruise rounding would add up
    append(now, 0.0, spare / limits.velocity);
  } else {
    const ThrustAndBrake course(from, limits);
    const Ramp to_rest = coasting_velocity(from, limits.jerk) < 0 ? ramp_up(from, 0.0, limits) : Ramp{};
    const double shortest = to_rest.onset + to_rest.hold;
    const double longest = std::max(shortest, to_cruise.onset + to_cruise.hold);
    const bool stops_there = std::abs(goal_ - stop) <= rounding * (std::abs(goal_) + std::abs(now.position));
    const double thrust =
        stops_there ? shortest : course.solve(distance, std::abs(goal_ - stop), shortest, longest);
    append(now, jerk, course.onset(thrust));
    append(now, 0.0, thrust - course.onset(thrust));
  }
  const Ramp brake = ramp_down(mirrored(now, sign), 0.0, limits);
  append(now, -jerk, brake.onset);
  append(now, 0.0, brake.hold);
  append(now, jerk, brake.release);
}

}  // namespace flinch
