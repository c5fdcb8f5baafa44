#pragma once

#include "drivers/dds_station.h"
#include "experiments/bus/interrupt_count.h"
#include "systems/framework/tick_source.h"
#include "systems/framework/time.h"

namespace flinch {

/// Throws SetupError where somebody has interrupted the program.
void throw_if_interrupted(const InterruptCount& interrupts);

/// Blocks until readings arrive that this program understands. Throws SetupError where that does not happen
/// within `patience`, with what was seen instead, and where somebody interrupts.
void await_robot(const DdsStation& station, Time patience, const InterruptCount& interrupts);

/// Lets the next tick start shortly after the readings that it shall see, and so all that follow. Blocks for
/// one reading, at most 100 ms.
void fall_into_step(DdsStation& station, ClockTicks& ticks);

}  // namespace flinch
