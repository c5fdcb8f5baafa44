// flinch run --station dds
#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/bus/interrupts.h"
#include "apps/flinch/bus/operator_console.h"
#include "apps/flinch/bus/orders_from_page.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/live/shown_run.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/stop_watch.h"
#include "apps/flinch/today.h"
#include "drivers/robot_pace.h"
#include "drivers/wire_header.h"
#include "experiments/bus/live_run.h"
#include "experiments/report/run_folder.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void tell_of_loop_and_link(const LiveRun& run) {
  const TickStatistics& loop = run.statistics();
  print_message("loop:      {} ticks, {} late starts, {} overruns, {} lost\n", loop.ticks, loop.late_starts,
                loop.overruns, loop.lost_periods);
  if (const DdsLink link = run.station().link(); link.robots > 1) {
    print_message("robots:    {} was commanded; on the bus were {}\n", robot_id_text(link.robot_id),
                  text_of(run.station().robots()));
  }
  const auto round_trip = run.station().times().round_trip.summary();
  const DdsLink link = run.station().link();
  if (!round_trip) return;
  print_message("link:      round trip p50 {:.0f}, p99 {:.0f}, most {:.0f} us; {} lost, {} refused\n",
                1e6 * to_seconds(round_trip->p50), 1e6 * to_seconds(round_trip->p99),
                1e6 * to_seconds(round_trip->max), link.lost, link.refused);
}

constexpr RealtimeSettings no_rights{.scheduling = Requirement::none,
                                     .locked_memory = Requirement::none,
                                     .realtime_kernel = Requirement::none};

/// What was asked for, else what the robot goes by; none: nobody says so.
std::optional<Pace> pace_of_run(const Scenario& scenario, const DdsBus& bus, const RunOptions& options) {
  if (options.bus.lockstep) return Pace::lockstep;
  if (options.bus.real_time) return Pace::real_time;
  return find_pace(bus, robot_hash(scenario.robot_text), options.bus.robot, from_seconds(options.patience),
                   [] { return Interrupts::count() > 0; });
}

void require_operators_time(const RunOptions& options, Pace pace) {
  if (pace == Pace::real_time || !options.attended) return;
  throw SetupError(
      "--attended: a robot in lockstep goes faster or slower than the time of its operator; start 'flinch "
      "serve' with --real-time");
}

const char* sentence(Pace pace) {
  return pace == Pace::lockstep
             ? "in lockstep: robot and controller wait for one another, and no clock takes part"
             : "in real time: who is late loses ticks";
}

}  // namespace

ExitStatus run_on_bus(const RunOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  Scenario scenario = read_scenario(options.input, options.set);
  if (!options.classifier.empty()) classifier_of(options.classifier)(scenario);
  if (options.attended) scenario.operator_script.events.clear();  // who attends does it in his place
  const Interrupts interrupts;
  const BusSettings settings = bus_settings(options.bus, silent);
  const DdsBus bus(settings);
  if (!silent) print_message("waiting for the robot, {}\n", name_of(options.bus));
  const std::optional<Pace> found = pace_of_run(scenario, bus, options);
  const Pace pace = found.value_or(Pace::real_time);
  const bool lockstep = pace == Pace::lockstep;
  const Time patience = from_seconds(options.patience);
  require_operators_time(options, pace);
  OrdersFromPage page;
  OrderFromPage to_page;
  if (options.attended) to_page = [&page](std::string_view order) { return page.follow(order); };
  const std::unique_ptr<ShownRun> shown = show_live(options, scenario, ShownPace::own, to_page);
  LiveRun run(scenario, bus,
              {.pace = pace,
               .patience = found ? patience : std::min<Time>(patience, 1s),  // it has been waited for
               .chosen_robot = options.bus.robot,
               .reset_faults = options.reset_faults,
               .attended = options.attended,
               .bus_priority = settings.realtime_priority,
               .loop = lockstep ? no_rights : loop_settings(options.bus),
               .interrupts = Interrupts::count,
               .spectator = shown ? &shown->spectator() : nullptr});
  out_of(name_of(options.bus), [&] { run.connect(); });
  if (!silent) print_message("{}\n", sentence(pace));
  const RunFolder folder = folder_of(options, scenario.name + "_" + moment_in_names());
  run.prepare(recording_in(folder),
              {{"command_line", options.common.command_line}, {"station", "dds, " + name_of(options.bus)}});
  tell_what_is_missing(run.granted(), silent);
  out_of(name_of(options.bus), [&] { run.enable(); });
  const StopWatch watch;
  double wall = 0.0;
  {
    std::optional<OperatorConsole> console;
    if (options.attended) console.emplace(scenario, run, silent);
    const OrdersFromPage::Taken taken(page, console ? &*console : nullptr);
    const auto ask = [&run, &console] {
      RunStatus now = run.watch();
      if (console) console->tell(now);
      return now;
    };
    const StatusLine line(ask, silent);
    run.run();
    wall = watch.seconds();
    run.end();
  }

  run.finish_recording();
  if (!run.ended_by().empty() && !silent) print_message("ended:     {}\n", run.ended_by());
  if (!silent && !lockstep) tell_of_loop_and_link(run);
  const ExitStatus status = conclude(scenario, wall, folder, options.common);
  if (shown) shown->finish(folder.path / "report.html");
  return status;
}

}  // namespace flinch
