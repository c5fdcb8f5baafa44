#pragma once

#include <string>
#include <vector>

#include "plant/bench_settings.h"

namespace flinch {

/// Every contact of the robot with an obstacle before anything has moved, one sentence each that names body,
/// obstacle and depth: a scene that cannot be meant. `settings` must be without problems.
std::vector<std::string> contacts_at_start(const BenchSettings& settings);

}  // namespace flinch
