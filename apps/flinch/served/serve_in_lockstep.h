#pragma once

#include "apps/flinch/bus/bus_verbs.h"

namespace flinch {

struct SimulatedScenario;

/// flinch serve --lockstep: the simulated robot waits for its controller at each tick. Throws SetupError.
ExitStatus serve_in_lockstep(const SimulatedScenario& scenario, const ServeOptions& options);

}  // namespace flinch
