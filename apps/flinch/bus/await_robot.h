#pragma once

#include "drivers/dds_station.h"
#include "systems/framework/time.h"

namespace flinch {

/// Throws SetupError where somebody has interrupted the program.
void throw_if_interrupted();

/// Blocks until readings arrive that this program understands. Throws SetupError where that does not happen
/// within `patience`, with what was seen instead, and where somebody interrupts.
void await_robot(const DdsStation& station, Time patience);

}  // namespace flinch
