#pragma once

#include <memory>

#include "systems/config/config_reader.h"

namespace flinch {

class ParallelRobot;
struct LegsParameters;
struct WorkspaceLimits;

/// The robot of kind `legs` that the keys in `file` describe. All that is wrong with them is noted, also
/// physically; nothing where something is wrong with the file.
std::shared_ptr<const ParallelRobot> read_legs(ConfigReader& file);

/// Keeps the drives of a robot of this kind, all alike, within the ranges of the joints that they drive: the
/// legs reach nothing beyond. Of a drive that moves with several joints nothing follows.
void begin_limits_of_legs(const ParallelRobot& robot, WorkspaceLimits& limits);

/// Its parameters as they stand there, without a look at what they mean.
LegsParameters read_legs_parameters(ConfigReader& file);

}  // namespace flinch
