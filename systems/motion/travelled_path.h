#pragma once

#include "systems/framework/never_allocates.h"
#include "systems/framework/time.h"
#include "systems/robot/configuration_space.h"
#include "systems/signals/history.h"

namespace flinch {

/// How far `displacement` moves a point at `reach` from E, at most [m].
double farthest_moved(const ConfigurationSpace& space, const PlatformVector& displacement,
                      double reach) noexcept;

/// Poses that the platform has come from, at least the last 0.3 s of its motion.
class TravelledPath {
 public:
  static constexpr Time spacing = 10ms;  ///< of its poses, at least

  /// Adds the pose at `now`, unless one was added less than `spacing` ago. What it knows from before `since`
  /// is forgotten: it led elsewhere.
  void add(Time now, Time since, const Configuration& pose) noexcept;

  /// The displacement from `pose` back to the latest of these poses that is `distance` [m] away, or to the
  /// oldest; only those count that are older than the nearest. Empty where the robot is half of `distance`
  /// off all of them, and where it would be led by less than a tenth of it: it hardly moved.
  PlatformVector way_back(const ConfigurationSpace& space, const Configuration& pose, double distance,
                          double reach) const noexcept;

 private:
  struct Pose {
    Time acquired{};
    Configuration pose;
  };
  History<Pose, 32> poses_;
};

template <>
inline constexpr bool never_allocates<TravelledPath> = never_allocates<Configuration>;

}  // namespace flinch
