#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace flinch {

struct Recording;

/// What of a simulated robot was drawn, and so differs from its model: under a key with its unit one number
/// for each joint, leg or encoder, in SI.
using DrawnValues = std::vector<std::pair<std::string, std::vector<double>>>;

/// Notes it among the attributes of a recording; nothing where nothing was drawn.
void note_robot(const DrawnValues& values, std::map<std::string, std::string>& attributes);

/// What a recording says of it. Throws SetupError where that cannot be read.
DrawnValues robot_as_drawn(const Recording& recording);

}  // namespace flinch
