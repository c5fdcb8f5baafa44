#pragma once

#include <memory>

#include "systems/config/config_reader.h"

namespace flinch {

class ParallelRobot;

/// The planar 3-RRR that the keys of its kind in `file` describe. All that is wrong with them is noted, also
/// physically; nothing where something is wrong with the file.
std::shared_ptr<const ParallelRobot> read_planar_rrr(ConfigReader& file);

}  // namespace flinch
