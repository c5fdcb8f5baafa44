#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "apps/flinch/command_line.h"

namespace flinch {

class Spectator;
struct Scenario;

/// A run that is watched in a browser, as --live asks.
class ShownRun {
 public:
  ShownRun() = default;
  ShownRun(const ShownRun&) = delete;
  ShownRun& operator=(const ShownRun&) = delete;
  virtual ~ShownRun() = default;

  /// Who is to see the run.
  virtual Spectator& spectator() = 0;
  /// Shows the report in the end; returns when every page has it, or Ctrl-C or the time given ends that.
  virtual void finish(const std::filesystem::path& report) = 0;
  /// The same without one.
  virtual void finish() = 0;
};

/// Who says how fast the run that is shown goes.
enum class ShownPace {
  ordered,  ///< the viewers of a simulation, by orders
  own,      ///< the robot
};

/// Follows what somebody ordered on a page; false: it is no order.
using OrderFromPage = std::function<bool(std::string_view order)>;

/// Prints the address on stderr; null where --live was not given. `scenario` must outlive it, and so must
/// what `operator_order` needs: called by other threads, of a run at its own pace; none: nobody orders there.
/// Throws SetupError where the port cannot be had, and where this program was built without a server.
std::unique_ptr<ShownRun> show_live(const RunOptions& options, const Scenario& scenario, ShownPace pace,
                                    OrderFromPage operator_order = {});
/// The same of a robot that is served.
std::unique_ptr<ShownRun> show_rig_live(const LiveOptions& live, const Scenario& scenario);

}  // namespace flinch
