// What stands in for 'flinch serve' in a program that was built without the simulation, or without the bus.
#include "apps/flinch/bus/bus_verbs.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

ExitStatus serve(const ServeOptions& options) {
  throw SetupError(options.scenario.string() +
                   ": cannot be served, for this flinch was built without the simulation or without Cyclone "
                   "DDS; build it with FLINCH_BUILD_PLANT=ON and FLINCH_BUILD_DRIVERS=ON");
}

}  // namespace flinch
