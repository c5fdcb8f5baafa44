#pragma once

#include "drivers/dds_station.h"
#include "experiments/bus/interrupt_count.h"
#include "systems/framework/tick_source.h"
#include "systems/framework/time.h"

namespace flinch {

/// Throws SetupError where somebody has interrupted the program.
void throw_if_interrupted(const InterruptCount& interrupts);

/// Throws SetupError where several robots could be meant, and says which there are.
void throw_if_undecided(const DdsStation& station);

/// Blocks until the station has taken its robot and readings arrive. Throws SetupError where that does not
/// happen within `patience`, with what was seen instead, and where somebody interrupts. Returns false where
/// several robots could be meant: then none is taken.
bool await_robot(DdsStation& station, Time patience, const InterruptCount& interrupts);

/// Lets the next tick start shortly after the readings that it shall see, and so all that follow. Blocks for
/// one reading, at most 100 ms.
void fall_into_step(DdsStation& station, ClockTicks& ticks);

}  // namespace flinch
