// flinch run --station dds
#include <fmt/core.h>

#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/run_folder.h"
#include "drivers/event_publisher.h"
#include "drivers/ros2_publisher.h"
#include "drivers/wire_header.h"
#include "experiments/bus/interrupts.h"
#include "experiments/bus/live_run.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/framework/exchange_list.h"

namespace flinch {
namespace {

Ros2Publisher shown_to_ros2(const DdsBus& bus, const LiveExperiment& experiment, int legs) {
  Ros2Settings settings;
  settings.ticks_between_messages = 10;
  for (int leg = 1; leg <= legs; ++leg) settings.joint_names.push_back("drive" + std::to_string(leg));
  return {bus,
          *experiment.diagram,
          {.joint_motion = experiment.control.joint_motion,
           .drive_torque = experiment.control.drive_torque,
           .imu = experiment.station.imu,
           .wrench = experiment.control.wrench_estimate,
           .gate = experiment.control.gate},
          settings};
}

EventSources told_of(const LiveExperiment& experiment) {
  const ExternalStation& station = experiment.station;
  return {.detection = experiment.control.detection,
          .reaction = experiment.control.reaction_state,
          .gate = experiment.control.gate,
          .timing = experiment.tick_timing,
          .links = {station.joints_link, station.drives_link, station.imu_link, station.status_link}};
}

void tell_of_loop_and_link(const LiveRun& run, const DdsStation& station) {
  const TickStatistics& loop = run.statistics();
  fmt::print(stderr, "loop:      {} ticks, {} late starts, {} overruns, {} lost\n", loop.ticks,
             loop.late_starts, loop.overruns, loop.lost_periods);
  const auto round_trip = station.times().round_trip.summary();
  const DdsLink link = station.link();
  if (!round_trip) return;
  fmt::print(stderr, "link:      round trip p50 {:.0f}, p99 {:.0f}, most {:.0f} us; {} lost, {} refused\n",
             1e6 * to_seconds(round_trip->p50), 1e6 * to_seconds(round_trip->p99),
             1e6 * to_seconds(round_trip->max), link.lost, link.refused);
}

}  // namespace

ExitStatus run_on_bus(const RunOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  const Scenario scenario = read_scenario(options.input);
  const LiveExperiment experiment = out_of(scenario.file, [&] { return build_live_experiment(scenario); });

  const Interrupts interrupts;
  const BusSettings settings = bus_settings(options.bus, silent);
  const DdsBus bus(settings);
  DdsStation station(
      bus, *experiment.diagram, experiment.station,
      {.robot = robot_hash(scenario.robot_text), .realtime_priority = settings.realtime_priority});
  OperatorPanel panel(experiment, station);
  Ros2Publisher ros2 = shown_to_ros2(bus, experiment, scenario.robot.robot->legs());
  EventPublisher events(bus, *experiment.diagram, told_of(experiment),
                        {.robot = robot_hash(scenario.robot_text), .session = station.session()});
  ExchangeList exchange({station, panel, ros2, events});
  LiveRun run(scenario, experiment, {station, panel, exchange}, from_seconds(options.patience));
  if (!silent) fmt::print(stderr, "waiting for the robot, {}\n", name_of(options.bus));
  out_of(name_of(options.bus), [&] { run.connect(); });
  const std::filesystem::path folder = make_run_folder(options, scenario.name);
  run.prepare(loop_settings(options.bus));
  tell_what_is_missing(run.granted(), silent);
  out_of(name_of(options.bus), [&] { run.enable(options.reset_faults); });
  const Time started = MonotonicClock::now();
  double wall = 0.0;
  {
    const StatusLine line([&run] { return run.watch(); }, silent);
    run.run();
    wall = to_seconds(MonotonicClock::now() - started);
    run.end();
  }

  const Recording recording = run.recording(
      {{"command_line", options.common.command_line}, {"station", "dds, " + name_of(options.bus)}});
  if (!silent) tell_of_loop_and_link(run, station);
  return conclude_run(scenario, recording, wall, folder, options.common);
}

}  // namespace flinch
