#include "apps/flinch/served/serve_in_lockstep.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/interrupts.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/live/shown_run.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/served/bus_warnings.h"
#include "apps/flinch/served/rig_recorder.h"
#include "drivers/lockstep_server.h"
#include "drivers/robot_id.h"
#include "drivers/wire_header.h"
#include "experiments/served/served_rig.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {
namespace {

/// What the loop says of itself, to who reads it.
class Teller {
 public:
  Teller(LockstepServer& server, BusWarnings& warnings, double patience, bool silent)
      : server_(server), warnings_(warnings), patience_(patience), silent_(silent) {}

  RunStatus operator()() {
    const LockstepState now = server_.state();
    RunStatus told = run_status(now);
    if (silent_) return told;
    told.said = warnings_.news();
    if (std::exchange(abandoned_, now.abandoned) != now.abandoned)
      told.said += fmt::format(
          "warning: the controller has sent nothing for {:g} s; waiting for the next one\n", patience_);
    return told;
  }

 private:
  static RunStatus run_status(const LockstepState& now) {
    const bool has_controller = now.controller != 0;
    return {fmt::format("drives: {}; {}", now.enabled ? "on" : "off",
                        has_controller ? fmt::format("waits for {:08x} at each tick", now.controller)
                                       : std::string("nobody commands")),
            fmt::format("at {:.1f} s, brakes {}, {} runs, {} commands, {} refused", to_seconds(now.time),
                        now.braked ? "closed" : "open", now.runs, now.received, now.refused)};
  }

  LockstepServer& server_;
  BusWarnings& warnings_;
  double patience_;  ///< [s]
  bool silent_;
  std::int64_t abandoned_ = 0;
};

/// What is measured by the clock is not known of a robot that waits.
void tell_the_end(const LockstepState& state, const CommonOptions& common) {
  if (common.json) {
    const nlohmann::ordered_json json = {{"pace", "lockstep"},       {"ticks", state.ticks},
                                         {"late_starts", nullptr},   {"overruns", nullptr},
                                         {"lost_periods", nullptr},  {"tick", nullptr},
                                         {"runs", state.runs},       {"commands", state.received},
                                         {"refused", state.refused}, {"abandoned", state.abandoned}};
    print_result("{}\n", json_text(json));
  } else if (!common.quiet) {
    print_result(
        "served {} ticks of {} runs in lockstep: {} commands, {} refused, {} controllers fell silent\n",
        state.ticks, state.runs, state.received, state.refused, state.abandoned);
  }
}

}  // namespace

ExitStatus serve_in_lockstep(const SimulatedScenario& scenario, const ServeOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  const WaitingRig rig =
      out_of(scenario.file, [&] { return build_waiting_rig(scenario, options.live.asked()); });
  const Interrupts interrupts;
  const double patience = options.patience.value_or(10.0);
  BusOptions where = options.bus;
  where.priority = 0;  // nothing is urgent
  const DdsBus bus(bus_settings(where, silent, BusRole::robot));
  LockstepServer server(bus, *rig.diagram, rig.station,
                        {.robot = robot_hash(scenario.robot_text),
                         .robot_name = where.robot,
                         .patience = from_seconds(patience)},
                        std::make_unique<SundialsIntegrator>());
  if (!silent) {
    print_message(
        "serving {} on {} as robot {} in lockstep: it waits for its controller at each tick, and its time is "
        "not that of the clock (--real-time: it is); Ctrl-C ends it\n",
        scenario.name, name_of(where), text_of(SeenRobot{server.robot_id(), where.robot}));
  }
  const auto shown = show_rig_live(options.live, scenario);
  if (shown) server.record(rig_recorder(*shown, *rig.diagram, scenario));
  BusWarnings warnings(bus, server.robot_id(), Pace::lockstep, [&] {
    return BusWarnings::Commanders{server.unreadable_commanders(), server.state().in_real_time};
  });
  const Time end = options.duration ? MonotonicClock::now() + from_seconds(*options.duration) : Time::max();
  {
    const StatusLine line(Teller(server, warnings, patience, silent), silent);
    server.run([end] { return Interrupts::count() > 0 || MonotonicClock::now() >= end; });
  }
  if (shown) shown->finish();
  tell_the_end(server.state(), options.common);
  return ExitStatus::done;
}

}  // namespace flinch
