#pragma once

#include <cstddef>
#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

/// Whether a robot can stand as its drives say, row after row.
struct KinematicCheck {
  /// Rows in which no leg changes the side of its elbow.
  struct Stretch {
    WorkingMode mode;
    Configuration pose;     ///< of the platform in its first row
    std::size_t first = 0;  ///< row; it ends where the next begins
  };
  /// A leg whose elbow is on another side than before.
  struct Fold {
    int leg = 0;          ///< from 0
    std::size_t row = 0;  ///< among those that were checked
  };
  double valid_fraction = 0.0;  ///< of the rows
  std::vector<Stretch> stretches;

  std::vector<Fold> folds() const;
  bool folds_from_home(const ParallelRobot& robot) const {
    return !stretches.empty() && stretches.front().mode != robot.home_working_mode();
  }
};

/// Follows the platform from its home pose; where the drives fit none in the working mode of the row before,
/// they may fit one with an elbow on its other side (a type-I singularity lies between). What stays as it is
/// is the assembly: only a type-II singularity could change that.
KinematicCheck check_kinematics(const ParallelRobot& robot, const std::vector<JointVector>& active);

}  // namespace flinch
