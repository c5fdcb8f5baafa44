#pragma once

#include <memory>

#include "systems/config/config_reader.h"

namespace flinch {

class ParallelRobot;

/// The five-bar that the keys of its kind in `file` describe. All that is wrong with them is noted, also
/// physically; nothing where something is wrong with the file.
std::shared_ptr<const ParallelRobot> read_five_bar(ConfigReader& file);

}  // namespace flinch
