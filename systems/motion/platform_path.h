#pragma once

#include <variant>
#include <vector>

#include "systems/motion/pose_motion.h"
#include "systems/motion/waypoint_circuit.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_reference.h"

namespace flinch {

/// A motion of the platform that is fixed before the run: pose, velocity and acceleration as functions of the
/// time since its start [s]. It begins and ends at rest. The factories throw SetupError for a path that
/// cannot be planned, that takes longer than 10,000 s, or that the legs do not reach everywhere; a path that
/// exists can be evaluated at any time.
class PlatformPath {
 public:
  /// Rest at the first pose, then along a straight line to rest at each of the others in turn, orientations
  /// the shorter way round; on the way it pauses so long at each [s]. One pose alone is a path that stays
  /// there.
  static PlatformPath through(const ParallelRobot& robot, const std::vector<Configuration>& poses,
                              const PoseLimits& limits, double pause = 0.0);

  /// A tour of waypoints, as often as it says.
  static PlatformPath around(const ParallelRobot& robot, const WaypointCircuit& circuit);

  /// The square of [SafePR] V-B about a pose, `side` in m.
  static PlatformPath square(const ParallelRobot& robot, const Configuration& centre, double side,
                             const PoseLimits& limits, int laps = 1);

  const Configuration& start() const noexcept { return start_; }
  /// Time until rest at the end [s].
  double duration() const noexcept { return duration_; }

  /// Motion at `time` [s]: rest at the start before it and at the end from `duration()` on. Not valid for
  /// NaN.
  PlatformReference evaluate(double time) const noexcept;

 private:
  struct Leg {
    double begin = 0.0;  ///< [s]
    PoseMotion motion;
  };
  using Legs = std::vector<Leg>;

  PlatformPath(const ParallelRobot& robot, std::variant<Legs, WaypointCircuit> course, double duration);

  std::variant<Legs, WaypointCircuit> course_;
  Configuration start_;
  double duration_;
};

/// A pose that is to be passed at constant velocity: for collision experiments, that of the obstacle.
struct PassageSettings {
  Configuration pose;          ///< passed with this orientation throughout
  CartesianVector direction;   ///< of the motion; any length but zero
  double speed = 0.0;          ///< [m/s]
  double cruise = 0.05;        ///< constant speed for at least so far before and after the pose [m]
  double acceleration = 20.0;  ///< [m/s^2]
  double jerk = 2000.0;        ///< [m/s^3]
};

/// The path of a passage, and when it passes.
struct Passage {
  PlatformPath path;
  double time = 0.0;  ///< since the start of the path [s]
};

/// Straight line that accelerates from rest, passes the pose at constant speed, and brakes. Throws SetupError
/// as PlatformPath does.
Passage passage(const ParallelRobot& robot, const PassageSettings& settings);

}  // namespace flinch
