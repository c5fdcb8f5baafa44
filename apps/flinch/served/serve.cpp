// flinch serve: the simulated rig on the bus; in real time as a driver program for real drives would be.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/bus/interrupts.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/fault_options.h"
#include "apps/flinch/live/shown_run.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/served/bus_warnings.h"
#include "apps/flinch/served/rig_recorder.h"
#include "apps/flinch/served/serve_in_lockstep.h"
#include "drivers/dds_server.h"
#include "drivers/robot_id.h"
#include "drivers/wire_header.h"
#include "experiments/bus/names.h"
#include "experiments/served/served_rig.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/exchange_list.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {
namespace {

/// What is told of a served rig.
struct ServedState {
  Time time{};
  DriveState drives = DriveState::not_ready_to_switch_on;
  bool braked = true;
  DdsCommander commander;
};

/// Takes it from the loop to whoever tells it.
class ServedMonitor final : public Exchange {
 public:
  ServedMonitor(const ServedRig& rig, const DdsServer& server)
      : server_(server),
        statusword_(rig.diagram->slot(rig.station.statusword)),
        status_(rig.diagram->slot(rig.station.status)) {}

  void take_outputs(const Context& context) override {
    states_.publish({.time = context.time(),
                     .drives = context[statusword_].state(),
                     .braked = context[status_].braked,
                     .commander = server_.commander()});
  }

  /// Commands of controllers in lockstep. For the same thread as last().
  std::uint32_t in_lockstep() const noexcept { return last_.commander.in_lockstep; }

  /// For one thread.
  const ServedState& last() {
    states_.take(last_);
    return last_;
  }

 private:
  const DdsServer& server_;
  Slot<Statusword> statusword_;
  Slot<StationStatus> status_;
  TripleBuffer<ServedState> states_;
  ServedState last_;
};

RunStatus run_status(const ServedState& now) {
  const bool commanded = now.commander.session != 0;
  return {fmt::format("drives: {}; brakes {}; {}", name(now.drives), now.braked ? "closed" : "open",
                      commanded ? fmt::format("commanded by {:08x}", now.commander.session)
                                : std::string("nobody commands")),
          fmt::format("at {:.1f} s, {} commands, {} refused, {} silences", to_seconds(now.time),
                      now.commander.received, now.commander.refused, now.commander.silences)};
}

nlohmann::ordered_json json_of(const DurationHistogram& histogram) {
  const auto summary = histogram.summary();
  if (!summary) return nullptr;
  return {{"p50_us", 1e6 * to_seconds(summary->p50)},
          {"p99_us", 1e6 * to_seconds(summary->p99)},
          {"max_us", 1e6 * to_seconds(summary->max)}};
}

void tell_the_end(const DdsCommander& commander, const TickStatistics& ticks, const CommonOptions& common) {
  if (common.json) {
    const nlohmann::ordered_json json = {{"pace", "real time"},
                                         {"ticks", ticks.ticks},
                                         {"late_starts", ticks.late_starts},
                                         {"overruns", ticks.overruns},
                                         {"lost_periods", ticks.lost_periods},
                                         {"tick", json_of(ticks.whole)},
                                         {"commands", commander.received},
                                         {"refused", commander.refused},
                                         {"for_other_robots", commander.for_others},
                                         {"silences", commander.silences}};
    print_result("{}\n", json_text(json));
  } else if (!common.quiet) {
    print_result(
        "served {} ticks: {} late starts, {} overruns, {} lost; {} commands, {} refused, {} of them for "
        "other "
        "robots, {} silences\n",
        ticks.ticks, ticks.late_starts, ticks.overruns, ticks.lost_periods, commander.received,
        commander.refused, commander.for_others, commander.silences);
  }
}

/// A computer that grants no real-time rights cannot promise to be in time.
bool is_in_lockstep(const BusOptions& bus) {
  const bool is_urgent = bus.priority > 0 && permits_realtime(bus.priority);
  return bus.lockstep || (!bus.real_time && !is_urgent);
}

ExitStatus serve_in_real_time(const SimulatedScenario& scenario, const ServeOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  DdsServerSettings settings{
      .robot = robot_hash(scenario.robot_text),
      .longest_silence = DdsServerSettings::longest_silence_at(scenario.control_period),
      .robot_name = options.bus.robot};
  const ServedRig rig = out_of(scenario.file, [&] {
    return build_served_rig(scenario, settings.longest_silence, options.live.asked());
  });
  Context context = rig.diagram->make_context();

  const Interrupts interrupts;
  const BusSettings bus_is = bus_settings(options.bus, silent, BusRole::robot);
  settings.realtime_priority = bus_is.realtime_priority;
  const DdsBus bus(bus_is);
  DdsServer server(bus, *rig.diagram, rig.station, settings);
  ServedMonitor watch(rig, server);
  ExchangeList exchange({server, watch});
  ClockTicks ticks;
  RealtimeRunner runner(*rig.diagram, ticks, exchange, std::make_unique<SundialsIntegrator>());
  const auto shown = show_rig_live(options.live, scenario);
  if (shown) runner.record(rig_recorder(*shown, *rig.diagram, scenario));
  if (!silent) {
    print_message(
        "serving {} on {} as robot {} in real time (--lockstep: it waits for its controller); Ctrl-C ends "
        "it\n",
        scenario.name, name_of(options.bus), text_of(SeenRobot{server.robot_id(), options.bus.robot}));
  }
  {
    BusWarnings beside(bus, server.robot_id(), Pace::real_time, [&] {
      return BusWarnings::Commanders{server.unreadable_commanders(), watch.in_lockstep()};
    });
    const auto ask = [&] {
      RunStatus now = run_status(watch.last());
      if (!silent) now.said = beside.news();
      return now;
    };
    const StatusLine line(ask, silent);
    const RealtimeThread thread(loop_settings(options.bus));
    tell_what_is_missing(thread.report(), silent);
    runner.run(context, options.duration ? from_seconds(*options.duration) : Time::max(),
               [] { return Interrupts::count() > 0; });
  }
  if (shown) shown->finish();
  tell_the_end(server.commander(), runner.statistics(), options.common);
  return ExitStatus::done;
}

}  // namespace

ExitStatus serve(const ServeOptions& options) {
  SimulatedScenario scenario = read_simulated_scenario(options.scenario, options.seed);
  add_faults(options.faults, *scenario.robot.robot, scenario.station.faults);
  if (is_in_lockstep(options.bus)) return serve_in_lockstep(scenario, options);
  if (options.patience) {
    throw SetupError("--patience: a robot that goes by the clock waits for nobody; with --lockstep it does");
  }
  return serve_in_real_time(scenario, options);
}

}  // namespace flinch
