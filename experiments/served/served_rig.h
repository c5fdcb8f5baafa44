#pragma once

#include <memory>

#include "drivers/powered_station.h"
#include "systems/framework/diagram.h"

namespace flinch {

struct SimulatedScenario;

/// The simulated rig of a scenario with drives that must be switched on, to be put on the bus. The inputs
/// of `station` are those of the diagram.
struct ServedRig {
  std::unique_ptr<Diagram> diagram;
  PoweredStation station;
};

/// The simulated rig of a scenario as the simulated experiment has it, its drives on, to wait for its
/// controller on the bus. The inputs of `station` are those of the diagram.
struct WaitingRig {
  std::unique_ptr<Diagram> diagram;
  Station station;
};

/// `is_watched`: its outputs have what a page shows of it, as does the next. Throws SetupError.
WaitingRig build_waiting_rig(const SimulatedScenario& scenario, bool is_watched = false);

/// `longest_silence`: after which the drives brake without a command. Throws SetupError.
ServedRig build_served_rig(const SimulatedScenario& scenario, Time longest_silence, bool is_watched = false);

}  // namespace flinch
