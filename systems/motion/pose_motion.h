#pragma once

#include "systems/motion/jerk_limited_profile.h"
#include "systems/motion/synchronised_motion.h"
#include "systems/signals/platform_reference.h"

namespace flinch {

/// Limits of a platform's motion: norms over the translations [m] and over the rotations [rad].
struct PoseLimits {
  MotionLimits translation;
  MotionLimits rotation;
};

/// Motion of the platform to rest at a goal pose: its position along a straight line, its orientation
/// likewise in its coordinates, each in its own time under its own limits. Time is in seconds since the start
/// of the motion.
class PoseMotion {
 public:
  /// Plans from `start`, moving with `start_velocity` and without acceleration, to rest at `goal`. The first
  /// `translations` coordinates are the position (2 planar, 3 spatial), the others, if any, the orientation:
  /// joined as they are, so give `start + robot.difference(goal, start)` for the shorter way round. Vectors
  /// that differ in size, fewer coordinates than translations, values that are not finite, or limits that are
  /// not positive give a motion that is not valid and rests at `start`.
  static PoseMotion plan(const PlatformVector& start, const PlatformVector& start_velocity,
                         const PlatformVector& goal, int translations, const PoseLimits& limits) noexcept;

  bool valid() const noexcept { return valid_; }
  /// Time until rest at the goal [s]; 0 if not valid.
  double duration() const noexcept;
  const PlatformVector& goal() const noexcept { return goal_; }

  /// Motion at `time` [s]: before the start that of time 0, from `duration()` on exactly rest at the goal.
  /// Not valid for a time that is NaN.
  PlatformReference evaluate(double time) const noexcept;

 private:
  SynchronisedMotion translation_;
  SynchronisedMotion rotation_;
  PlatformVector goal_;
  bool valid_ = false;
};

}  // namespace flinch
