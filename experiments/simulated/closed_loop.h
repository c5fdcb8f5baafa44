#pragma once

#include "diagrams/contact_control.h"
#include "plant/simulated_station.h"

namespace flinch {

struct SimulatedScenario;

/// The simulated station of a scenario and the control path, wired together. Inputs of the operator are left
/// to be connected or exported.
struct StationAndControl {
  SimulatedStation station;
  ContactControl control;
};

/// Adds the closed loop of a scenario with these settings of the control path. Where the scenario wants that
/// it is told the truth of contacts, and what it is told is exported. Throws SetupError for settings that do
/// not fit together.
StationAndControl add_closed_loop(DiagramBuilder& builder, const SimulatedScenario& scenario,
                                  ContactControlSettings settings);

}  // namespace flinch
