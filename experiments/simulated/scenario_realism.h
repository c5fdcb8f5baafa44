#pragma once

#include "plant/realism.h"

namespace flinch {

class ConfigReader;
class ParallelRobot;

/// Reads `realism` of the section `plant`: "none", "bench", or a section with the sizes one by one, where
/// those that are left out are as in what it is `like`.
Realism read_realism(ConfigReader& plant, const ParallelRobot& robot);

}  // namespace flinch
