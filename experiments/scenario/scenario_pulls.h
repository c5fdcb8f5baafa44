#pragma once

#include <vector>

#include "systems/signals/instrument_mounting.h"

namespace flinch {

class ConfigReader;
class Mechanism;

/// Reads where the force-torque instrument sits while ropes are pulled: the list `pulls` of a scenario, in
/// the order of the starts. How hard is pulled is for a simulation to read.
std::vector<InstrumentMounting> read_mountings(ConfigReader& scenario, const Mechanism& robot);

}  // namespace flinch
