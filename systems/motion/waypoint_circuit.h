#pragma once

#include <array>
#include <optional>
#include <span>

#include "systems/motion/jerk_limited_profile.h"
#include "systems/motion/pose_motion.h"
#include "systems/robot/configuration_space.h"
#include "systems/signals/platform_reference.h"

namespace flinch {

/// A closed tour of poses: from rest at the first to rest at each one after it and back to the first, in
/// straight lines, position and orientation arriving together; as many laps as wanted. Time is in seconds
/// since the start. A default-constructed circuit has no coordinates and is not valid.
class WaypointCircuit {
 public:
  static constexpr int max_waypoints = 8;

  /// Plans a tour of 2 to `max_waypoints` poses, each joined to the next by the shorter way. Every leg takes
  /// the shortest time that the limits allow. Anything else, values that are not finite, limits that are not
  /// positive or less than one lap give a circuit that is not valid and rests at the first pose.
  static WaypointCircuit plan(const ConfigurationSpace& space, std::span<const Configuration> waypoints,
                              const PoseLimits& limits, int laps = 1) noexcept;

  bool valid() const noexcept { return valid_; }
  double lap_duration() const noexcept { return lap_duration_; }
  /// Time until rest at the end of the last lap [s]; 0 if not valid.
  double duration() const noexcept { return laps_ * lap_duration_; }

  /// Motion at `time` [s]: rest at the first pose before the start and from `duration()` on. Not valid for a
  /// time that is NaN.
  PlatformReference evaluate(double time) const noexcept;

 private:
  struct Leg {
    Configuration start;
    PlatformVector displacement;
    JerkLimitedProfile share;  ///< of the displacement, from 0 to 1
    double begin = 0.0;        ///< since the start of the lap [s]
  };

  std::array<Leg, max_waypoints> legs_;
  std::optional<ConfigurationSpace> space_;  ///< none: nothing has been planned
  Configuration first_;
  int count_ = 0;
  int laps_ = 0;
  double lap_duration_ = 0.0;
  bool valid_ = false;
};

/// Corners of a square of the given side [m] about the position of a pose, parallel to the x and y axes of
/// the base frame, counter-clockwise from the one with least x and y, all with the orientation of that pose.
/// Source: contact-free motion of [SafePR] V-B, side 0.3 m.
std::array<Configuration, 4> square_corners(const Configuration& centre, double side) noexcept;

}  // namespace flinch
