#pragma once

#include <memory>

#include "systems/config/config_reader.h"

namespace flinch {

class ParallelRobot;

/// The hexapod 6-UPS that the keys of its kind in `file` describe. All that is wrong with them is noted, also
/// physically; nothing where something is wrong with the file.
std::shared_ptr<const ParallelRobot> read_hexapod(ConfigReader& file);

}  // namespace flinch
