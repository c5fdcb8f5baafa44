#pragma once

#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

/// Why a robot cannot stand as its drives say: what would have to be changed in the angles so that it can, in
/// at least 99 % of the rows. Tried are another unit, a drive that counts the other way, two drives that are
/// swapped. Empty: it can stand in 90 % of the rows as they are, or nothing of that helps.
std::vector<std::string> likely_kinematic_causes(const ParallelRobot& robot,
                                                 const std::vector<JointVector>& active);

/// The same as one sentence; `otherwise` where there are none.
std::string told_kinematic_causes(const ParallelRobot& robot, const std::vector<JointVector>& active,
                                  const std::string& otherwise);

}  // namespace flinch
