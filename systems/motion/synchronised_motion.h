#pragma once

#include "systems/motion/jerk_limited_profile.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Motion of a vector at an instant, one entry per coordinate [m or rad, and per s, s^2]. Where it is not
/// valid, it rests.
struct VectorMotion {
  bool valid = false;
  PlatformVector position;
  PlatformVector velocity;
  PlatformVector acceleration;
};

/// Jerk-limited motion of a vector (position, orientation or task) to rest at a goal, all coordinates
/// together along the straight line from start to goal. The limits bound Euclidean norms, whatever the
/// direction. Time is in seconds since the start of the motion.
///
/// The start may move in any direction. Its velocity is split into the part v along the line, with unit
/// vector e, and the part w across it, with unit vector n:
///   x(t) = x_start + s(t) e + c(t) n,   s from (0, v) to the distance,   c from (0, w) back to 0,
/// with one profile each. While c lasts, both share the limits: each has 1/sqrt(2) of acceleration and jerk,
/// c has the velocity it needs, at most 1/sqrt(2) of the limit, and s the rest. When c has come to rest, s is
/// planned anew with all of the limits. So acceleration and jerk never exceed them, the speed never exceeds
/// the larger of limit and initial speed, and without velocity across the line the motion is time-optimal. If
/// start and goal coincide, the line is that of the initial velocity. A default-constructed motion has no
/// coordinates and is not valid.
class SynchronisedMotion {
 public:
  /// Plans from `start`, moving with `start_velocity` and without acceleration, to rest at `goal`;
  /// coordinates are joined as they are, so angles must not be wrapped apart. Vectors that differ in size,
  /// are empty or not finite, or limits that are not positive, give a motion that is not valid and rests at
  /// `start`.
  static SynchronisedMotion plan(const PlatformVector& start, const PlatformVector& start_velocity,
                                 const PlatformVector& goal, const MotionLimits& limits) noexcept;

  bool valid() const noexcept { return valid_; }
  /// Time until rest at the goal [s]; 0 if not valid.
  double duration() const noexcept { return valid_ ? handover_ + alone_.duration() : 0.0; }
  const PlatformVector& goal() const noexcept { return goal_; }

  /// Motion at `time` [s]: before the start that of time 0, from `duration()` on exactly rest at the goal.
  /// Not valid for a time that is NaN.
  VectorMotion evaluate(double time) const noexcept;

 private:
  void plan_profiles(double distance, double along, double across, const MotionLimits& limits) noexcept;

  PlatformVector start_;
  PlatformVector goal_;
  PlatformVector e_;             ///< unit vector along the line
  PlatformVector n_;             ///< unit vector across it, zero if not needed
  JerkLimitedProfile together_;  ///< along the line until the handover
  JerkLimitedProfile alone_;     ///< along the line from the handover on
  JerkLimitedProfile across_;    ///< across the line, at rest from the handover on
  double handover_ = 0.0;        ///< [s]
  bool valid_ = false;
};

}  // namespace flinch
