// flinch serve: the simulated bench on the bus, in real time, as a driver program for real drives would be.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/bus/interrupts.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/fault_options.h"
#include "apps/flinch/printing.h"
#include "drivers/dds_reader.h"
#include "drivers/dds_server.h"
#include "drivers/robot_id.h"
#include "drivers/wire_header.h"
#include "experiments/bus/names.h"
#include "experiments/served/served_bench.h"
#include "experiments/simulated/simulated_scenario.h"
#include "plant/sundials_integrator.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/framework/exchange_list.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {
namespace {

/// What is told of a served bench.
struct ServedState {
  Time time{};
  DriveState drives = DriveState::not_ready_to_switch_on;
  bool braked = true;
  DdsCommander commander;
};

/// Takes it from the loop to whoever tells it.
class ServedWatch final : public Exchange {
 public:
  ServedWatch(const ServedBench& bench, const DdsServer& server)
      : server_(server),
        statusword_(bench.diagram->slot(bench.station.statusword)),
        status_(bench.diagram->slot(bench.station.status)) {}

  void take_outputs(const Context& context) override {
    states_.publish({.time = context.time(),
                     .drives = context[statusword_].state(),
                     .braked = context[status_].braked,
                     .commander = server_.commander()});
  }

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

Tidings tidings(const ServedState& now) {
  const bool commanded = now.commander.session != 0;
  return {fmt::format("drives: {}; brakes {}; {}", name(now.drives), now.braked ? "closed" : "open",
                      commanded ? fmt::format("commanded by {:08x}", now.commander.session)
                                : std::string("nobody commands")),
          fmt::format("at {:.1f} s, {} commands, {} refused, {} silences", to_seconds(now.time),
                      now.commander.received, now.commander.refused, now.commander.silences)};
}

/// What a user should know of the others on the bus, each once.
class BusWarnings {
 public:
  BusWarnings(const DdsBus& bus, const DdsServer& server) : bus_(bus), server_(server) {}

  /// Looks once a second.
  std::string news() {
    const Time now = MonotonicClock::now();
    if (now < next_look_) return "";
    next_look_ = now + 1s;
    return news_of_robots() + news_of_commanders();
  }

 private:
  std::string news_of_robots() {
    const int robots = writers_on(bus_, status_topic);
    if (robots <= std::exchange(robots_, robots)) return "";
    return fmt::format(
        "warning: {} robots are on this bus; who commands one must choose it with --robot; this is {}\n",
        robots, robot_id_text(server_.robot_id()));
  }

  /// A program that has just joined is not understood for an instant.
  std::string news_of_commanders() {
    const int last = std::exchange(unreadable_, server_.unreadable_commanders());
    const int lasting = std::min(last, unreadable_);
    if (lasting <= std::exchange(told_unreadable_, lasting)) return "";
    return "warning: a program commands in another version of the protocol, and is not obeyed; build both "
           "ends from the same flinch\n";
  }

  const DdsBus& bus_;
  const DdsServer& server_;
  Time next_look_ = MonotonicClock::now() + 500ms;
  int robots_ = 1;
  int unreadable_ = 0;
  int told_unreadable_ = 0;
};

nlohmann::ordered_json json_of(const DurationHistogram& histogram) {
  const auto summary = histogram.summary();
  if (!summary) return nullptr;
  return {{"p50_us", 1e6 * to_seconds(summary->p50)},
          {"p99_us", 1e6 * to_seconds(summary->p99)},
          {"max_us", 1e6 * to_seconds(summary->max)}};
}

void tell_the_end(const DdsCommander& commander, const TickStatistics& ticks, const CommonOptions& common) {
  if (common.json) {
    const nlohmann::ordered_json json = {
        {"ticks", ticks.ticks},          {"late_starts", ticks.late_starts},
        {"overruns", ticks.overruns},    {"lost_periods", ticks.lost_periods},
        {"tick", json_of(ticks.whole)},  {"commands", commander.received},
        {"refused", commander.refused},  {"for_other_robots", commander.for_others},
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

}  // namespace

ExitStatus serve(const ServeOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  SimulatedScenario scenario = read_simulated_scenario(options.scenario, options.seed);
  add_faults(options.faults, *scenario.robot.robot, scenario.station.faults);
  DdsServerSettings settings{.robot = robot_hash(scenario.robot_text), .robot_name = options.bus.robot};
  const ServedBench bench =
      out_of(scenario.file, [&] { return build_served_bench(scenario, settings.longest_silence); });
  Context context = bench.diagram->make_context();

  const Interrupts interrupts;
  const BusSettings bus_is = bus_settings(options.bus, silent, BusRole::robot);
  settings.realtime_priority = bus_is.realtime_priority;
  const DdsBus bus(bus_is);
  DdsServer server(bus, *bench.diagram, bench.station, settings);
  ServedWatch watch(bench, server);
  ExchangeList exchange({server, watch});
  ClockTicks ticks;
  RealtimeRunner runner(*bench.diagram, ticks, exchange, std::make_unique<SundialsIntegrator>());
  if (!silent) {
    print_message("serving {} on {} as robot {}; Ctrl-C ends it\n", scenario.name, name_of(options.bus),
                  text_of(SeenRobot{server.robot_id(), options.bus.robot}));
  }
  {
    BusWarnings beside(bus, server);
    const auto ask = [&] {
      Tidings now = tidings(watch.last());
      if (!silent) now.said = beside.news();
      return now;
    };
    const StatusLine line(ask, silent);
    const RealtimeThread thread(loop_settings(options.bus));
    tell_what_is_missing(thread.report(), silent);
    runner.run(context, options.duration ? from_seconds(*options.duration) : Time::max(),
               [] { return Interrupts::count() > 0; });
  }
  tell_the_end(server.commander(), runner.statistics(), options.common);
  return ExitStatus::done;
}

}  // namespace flinch
