#pragma once

#include <array>
#include <span>

namespace flinch {

/// Bounds on the magnitudes of velocity [m/s or rad/s], acceleration [.../s^2] and jerk [.../s^3] of a
/// motion. All three must be positive and finite to plan with.
struct MotionLimits {
  double velocity = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

/// Whether all three limits are positive and finite.
bool can_be_planned_with(const MotionLimits& limits) noexcept;

/// Motion of one coordinate at an instant [m or rad, and per s, s^2, s^3].
struct ScalarMotion {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

/// Double-S profile of one coordinate: trapezoidal acceleration, limited jerk, from any motion to rest at a
/// goal in the shortest time. Time is in seconds since the start of the profile.
///
/// A start outside the limits is brought inside first: the acceleration at full jerk, then the velocity by
/// the ramp that leads to the limit without crossing it, so both return monotonically. From there on the
/// profile is time-optimal: it accelerates towards the goal as seen from where braking at once would come to
/// rest (so it overshoots and returns where it must), cruises at the velocity limit if that is reached, and
/// brakes. A default-constructed profile rests at 0 and is not valid.
class JerkLimitedProfile {
 public:
  /// Most phases of constant jerk: 3 to enter the limits, 3 to cruise velocity, cruise, 3 to rest.
  static constexpr int max_phases = 10;

  struct Phase {
    double begin = 0.0;     ///< [s]
    ScalarMotion at_begin;  ///< its jerk lasts until the next phase begins
  };

  /// Plans from `start` (whose jerk is not used) to rest at `goal`. Input that is not finite, limits that are
  /// not positive, or a duration too long to represent give a profile that is not valid and rests at `start`.
  static JerkLimitedProfile plan(const ScalarMotion& start, double goal, const MotionLimits& limits) noexcept;

  bool valid() const noexcept { return valid_; }
  /// Time until rest at the goal [s]; 0 if not valid.
  double duration() const noexcept { return duration_; }
  double goal() const noexcept { return goal_; }

  /// Motion at `time` [s]: before the start that of time 0, from `duration()` on exactly rest at the goal. At
  /// the border of two phases the jerk is that of the later one. A time that is NaN gives NaN.
  ScalarMotion evaluate(double time) const noexcept;

  /// Phases of non-zero length in order of time; the last one ends at `duration()`.
  std::span<const Phase> phases() const noexcept;

 private:
  void enter_acceleration_limit(ScalarMotion& now, const MotionLimits& limits) noexcept;
  void enter_velocity_limit(ScalarMotion& now, const MotionLimits& limits) noexcept;
  void reach_goal(ScalarMotion& now, const MotionLimits& limits) noexcept;
  void append(ScalarMotion& now, double jerk, double time) noexcept;

  std::array<Phase, max_phases> phases_{};
  int count_ = 0;
  double duration_ = 0.0;
  double goal_ = 0.0;
  bool valid_ = false;
};

}  // namespace flinch
