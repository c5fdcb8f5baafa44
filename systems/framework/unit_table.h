#pragma once

#include <map>
#include <string>

namespace flinch {

/// The units of quantities that are not the same for every mechanism. A field may give its unit as the name
/// of a quantity in angle brackets, "<wrench>"; a Recorder looks up what it stands for: {"<wrench>", "N, N,
/// Nm"}. systems/robot/quantity_units.h has the table of a robot.
using UnitTable = std::map<std::string, std::string>;

}  // namespace flinch
