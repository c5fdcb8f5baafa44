#pragma once

#include <limits>
#include <string>
#include <vector>

#include "systems/robot/vectors.h"

namespace flinch {

class Mechanism;
class ParallelRobot;
struct Kinematics;

/// Where a robot may be; outside it must be brought to rest. The defaults allow everything.
struct WorkspaceLimits {
  CartesianVector centre;  ///< Of the workspace, in the base frame [m]; empty: the base origin.
  /// Of the platform from the centre [m].
  double max_distance = std::numeric_limits<double>::infinity();
  /// Angle by which the platform is turned against the base frame [rad].
  double max_rotation = std::numeric_limits<double>::infinity();

  double min_abs_det_A = 0.0;                ///< Room to type-II singularities: least |Kinematics::det_A|.
  double min_abs_det_B = 0.0;                ///< Room to type-I singularities: least |Kinematics::det_B|.
  double min_self_collision_distance = 0.0;  ///< Least sigma_sc between link axes [m].
  double min_platform_gap = 0.0;             ///< Least Mechanism::platform_gap() [m].

  double min_active = -std::numeric_limits<double>::infinity();  ///< Of every drive [rad or m].
  double max_active = std::numeric_limits<double>::infinity();   ///< Of every drive [rad or m].
};

/// Distance of a pose from the centre of `limits` [m].
double distance_from_centre(const WorkspaceLimits& limits, const Mechanism& mechanism,
                            const Configuration& pose) noexcept;

/// Whether a robot is within `limits` where it is; not where its kinematics is not valid.
bool is_within(const WorkspaceLimits& limits, const Mechanism& mechanism,
               const Kinematics& kinematics) noexcept;

/// All that is wrong with `limits`, one sentence each that begins with the field, such as
/// "max_distance is 0 m; it must be positive". A robot at rest at its home pose must be within them.
std::vector<std::string> problems(const WorkspaceLimits& limits, const ParallelRobot& robot);

}  // namespace flinch
