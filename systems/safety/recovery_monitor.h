#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"
#include "systems/signals/gate_fault.h"
#include "systems/signals/joint_motion.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {

/// Faults that say where the robot stands, and that it can leave behind under its own power.
inline constexpr std::array faults_of_place{GateFault::type_1_singularity, GateFault::type_2_singularity,
                                            GateFault::workspace_radius,   GateFault::orientation,
                                            GateFault::joint_range,        GateFault::self_collision};

/// By how much the robot stands beyond the limit of each, as a share of the limit (of a range: of its width);
/// negative within, not a number where it is not known, nor where only a type-II singularity leads back.
using PlaceExcess = std::array<double, faults_of_place.size()>;

/// What a tick tells about the robot's place.
struct PlaceTick {
  const ParallelRobot& robot;
  const WorkspaceLimits& limits;
  const JointMotion& motion;
  const PlatformMotion& platform;
  const WorkspaceMeasures& measures;  ///< det A positive on the side of home
};

PlaceExcess place_excess(const PlaceTick& tick) noexcept;

/// How near to its limits the robot has come since the recovery began.
struct RecoveryMonitor {
  PlaceExcess now{};
  PlaceExcess least{};      ///< since then; infinite while there is no recovery
  bool recovering = false;  ///< the reaction sequence is in the mode `recover`
};

/// The watch after a tick.
void advance(RecoveryMonitor& watch, const PlaceTick& tick, bool recovering) noexcept;

/// The faults of place that a recovery bears: those that are no further beyond their limit than they have
/// been since it began, but for `margin`.
FaultMask tolerable_faults(const RecoveryMonitor& watch, double margin) noexcept;

}  // namespace flinch
