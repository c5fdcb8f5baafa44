#pragma once

#include <limits>
#include <string>
#include <vector>

namespace flinch {

class ParallelRobot;

/// Where a robot may be; outside it must be brought to rest. The defaults allow everything.
struct WorkspaceLimits {
  double max_distance =
      std::numeric_limits<double>::infinity();  ///< Of the platform from the base origin [m].
  double max_rotation = std::numeric_limits<double>::infinity();  ///< |phi| of a planar platform [rad].

  double min_abs_det_A = 0.0;                ///< Room to type-II singularities: least |Kinematics::det_A|.
  double min_abs_det_B = 0.0;                ///< Room to type-I singularities: least |Kinematics::det_B|.
  double min_self_collision_distance = 0.0;  ///< Least sigma_sc between link axes [m].

  double min_active_angle = -std::numeric_limits<double>::infinity();  ///< Of every drive [rad].
  double max_active_angle = std::numeric_limits<double>::infinity();   ///< Of every drive [rad].
};

/// All that is wrong with `limits`, one sentence each that begins with the field, such as
/// "max_distance is 0 m; it must be positive". A robot at rest at its home pose must be within them.
std::vector<std::string> problems(const WorkspaceLimits& limits, const ParallelRobot& robot);

}  // namespace flinch
