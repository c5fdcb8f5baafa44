#pragma once

#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

/// What a classifier can take for touched, by numbers of ContactClasses: "platform", "leg1_link2",
/// "leg1_clamping"; "leg1" of a leg whose links load the robot alike.
std::vector<std::string> names_of_touched(const ParallelRobot& robot);

/// Whether what is `told` is that body: "leg1" is either of its links, or both.
bool names_body(const std::string& told, const std::string& body);

}  // namespace flinch
