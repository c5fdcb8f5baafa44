// What stands in for the verbs of the bus in a program that was built without Cyclone DDS.
#include "apps/flinch/bus/bus_verbs.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

[[noreturn]] ExitStatus refuse(const std::string& verb) {
  throw SetupError("flinch " + verb +
                   ": there is no bus, for this flinch was built without Cyclone DDS; install it, and build "
                   "with FLINCH_BUILD_DRIVERS=ON");
}

}  // namespace

ExitStatus run_on_bus(const RunOptions&) { refuse("run --station dds"); }
ExitStatus link(const LinkOptions&) { refuse("link"); }
ExitStatus keys(const KeysOptions&) { refuse("keys"); }

}  // namespace flinch
