// What stands in for the live view in a program that was built without a server.
#include "apps/flinch/live/shown_run.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

namespace {

/// What `live` asks for cannot be had.
std::unique_ptr<ShownRun> without_server(const LiveOptions& live) {
  if (!live.asked()) return nullptr;
  throw SetupError(
      "--live: this flinch was built without cpp-httplib; install it (Debian: libcpp-httplib-dev) and build "
      "again");
}

}  // namespace

std::unique_ptr<ShownRun> show_live(const RunOptions& options, const Scenario& /*scenario*/,
                                    ShownPace /*pace*/, OrderFromPage /*operator_order*/) {
  return without_server(options.live);
}

std::unique_ptr<ShownRun> show_rig_live(const LiveOptions& live, const Scenario& /*scenario*/) {
  return without_server(live);
}

}  // namespace flinch
