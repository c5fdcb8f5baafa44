#pragma once

#include <cstdint>
#include <numbers>

#include "systems/framework/random.h"
#include "systems/motion/platform_path.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {

/// Motion that goes everywhere: for what must hold of any motion, such as thresholds without a contact.
struct RandomPathSettings {
  double duration = 6.0;                     ///< the motion lasts at least so long [s]
  Configuration centre;                      ///< of the poses; empty: home
  double distance = 0.2;                     ///< poses lie within it of the centre [m]
  double rotation = std::numbers::pi / 9.0;  ///< and are turned by at most this against it [rad]
  double pause = 0.0;                        ///< at each pose [s]
  PoseLimits limits{.translation = {.velocity = 1.5, .acceleration = 12.0, .jerk = 600.0},
                    .rotation = {.velocity = 4.0, .acceleration = 80.0, .jerk = 8000.0}};

  /// Which the way between the poses keeps with a tenth of each to spare, so that a robot which follows it
  /// with some error keeps them as well.
  WorkspaceLimits workspace;
  double max_drive_speed = 0.0;  ///< likewise [rad/s or m/s]
};

/// Straight lines from rest to rest between random poses, from the centre on: the position uniform in a disc
/// or ball, the orientation likewise. Poses to which the way is not within the limits are drawn again. Throws
/// SetupError where hardly any is, where the path has more than 50,000 poses, or where it cannot be planned.
PlatformPath random_path(const ParallelRobot& robot, const RandomPathSettings& settings, std::uint64_t seed);

/// One of its poses, whether it can be reached or not.
Configuration random_pose(const ParallelRobot& robot, const RandomPathSettings& settings,
                          RandomGenerator& random);

/// Whether all of a path is within the limits, with a tenth to spare.
bool stays_within(const ParallelRobot& robot, const PlatformPath& path, const RandomPathSettings& settings);

}  // namespace flinch
