// What stands in for the live view in a program that was built without a server.
#include "apps/flinch/live/shown_run.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

std::unique_ptr<ShownRun> show_live(const RunOptions& options, const Scenario& /*scenario*/,
                                    ShownPace /*pace*/, OrderFromPage /*operator_order*/) {
  if (!options.live.asked()) return nullptr;
  throw SetupError(
      "--live: this flinch was built without cpp-httplib; install it (Debian: libcpp-httplib-dev) and build "
      "again");
}

}  // namespace flinch
