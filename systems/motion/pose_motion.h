#pragma once

#include <optional>

#include "systems/framework/never_allocates.h"
#include "systems/motion/jerk_limited_profile.h"
#include "systems/motion/synchronised_motion.h"
#include "systems/robot/configuration_space.h"
#include "systems/signals/platform_reference.h"

namespace flinch {

/// Limits of a platform's motion: norms over the translations [m] and over the rotations [rad].
struct PoseLimits {
  MotionLimits translation;
  MotionLimits rotation;
};

/// Whether the first `translations` entries of a platform's velocity, or the others, are faster than a motion
/// with these limits is: to come to rest within them it would go on for longer than anybody expects.
bool is_faster(const PlatformVector& velocity, int translations, const PoseLimits& limits) noexcept;

/// Motion of the platform to rest at a goal pose: its position along a straight line, its orientation about a
/// fixed axis, each in its own time under its own limits. Time is in seconds since the start of the motion.
/// Where the platform turns about another axis at first, the limits of the rotation hold for its rotation
/// vector from the start.
class PoseMotion {
 public:
  /// Plans from `start`, moving with `start_velocity` and without acceleration, to rest at start (+)
  /// `displacement`; `space.difference(goal, start)` is the shorter way to a goal. Vectors that do not fit
  /// the space, values that are not finite, or limits that are not positive give a motion that is not valid
  /// and rests at `start`.
  static PoseMotion plan(const ConfigurationSpace& space, const Configuration& start,
                         const PlatformVector& start_velocity, const PlatformVector& displacement,
                         const PoseLimits& limits) noexcept;

  bool valid() const noexcept { return valid_; }
  /// Time until rest at the goal [s]; 0 if not valid.
  double duration() const noexcept;
  Configuration goal() const noexcept { return space_ ? space_->plus(start_, displacement_) : start_; }

  /// Motion at `time` [s]: before the start that of time 0, from `duration()` on exactly rest at the goal.
  /// Not valid for a time that is NaN.
  PlatformReference evaluate(double time) const noexcept;

 private:
  std::optional<ConfigurationSpace> space_;  ///< none: nothing has been planned
  Configuration start_;
  PlatformVector displacement_;
  SynchronisedMotion translation_;
  SynchronisedMotion rotation_;
  bool valid_ = false;
};

template <>
inline constexpr bool never_allocates<PoseMotion> =
    never_allocates<Configuration>&& never_allocates<PlatformVector>;

}  // namespace flinch
