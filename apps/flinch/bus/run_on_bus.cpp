// flinch run --station dds
#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/bus/interrupts.h"
#include "apps/flinch/bus/operator_console.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/stop_watch.h"
#include "experiments/bus/live_run.h"
#include "experiments/report/run_folder.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/problems_of_place.h"

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

}  // namespace

ExitStatus run_on_bus(const RunOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  Scenario scenario = read_scenario(options.input, options.set);
  if (!options.classifier.empty()) classifier_of(options.classifier)(scenario);
  if (options.attended) scenario.operator_script.events.clear();  // who attends does it in his place
  const Interrupts interrupts;
  const BusSettings settings = bus_settings(options.bus, silent);
  const DdsBus bus(settings);
  LiveRun run(scenario, bus,
              {.patience = from_seconds(options.patience),
               .chosen_robot = options.bus.robot,
               .reset_faults = options.reset_faults,
               .attended = options.attended,
               .bus_priority = settings.realtime_priority,
               .loop = loop_settings(options.bus),
               .interrupts = Interrupts::count});
  if (!silent) print_message("waiting for the robot, {}\n", name_of(options.bus));
  out_of(name_of(options.bus), [&] { run.connect(); });
  const RunFolder folder = folder_of(options, scenario.name);
  run.prepare(recording_in(folder),
              {{"command_line", options.common.command_line}, {"station", "dds, " + name_of(options.bus)}});
  tell_what_is_missing(run.granted(), silent);
  out_of(name_of(options.bus), [&] { run.enable(); });
  const StopWatch watch;
  double wall = 0.0;
  {
    std::optional<OperatorConsole> console;
    if (options.attended) console.emplace(scenario, run, silent);
    const auto ask = [&run, &console] {
      Tidings now = run.watch();
      if (console) console->tell(now);
      return now;
    };
    const StatusLine line(ask, silent);
    run.run();
    wall = watch.seconds();
    run.end();
  }

  run.finish_recording();
  if (run.was_left() && !silent) {
    print_message("ended:     the robot has sent nothing for {:.0f} s\n", options.patience);
  }
  if (!silent) tell_of_loop_and_link(run);
  return conclude(scenario, wall, folder, options.common);
}

}  // namespace flinch
