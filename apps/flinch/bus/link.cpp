// flinch link: how good the way to the robot is, before anything moves.
#include <fmt/core.h>

#include <atomic>

#include "apps/flinch/bus/bus_start.h"
#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/bus/interrupts.h"
#include "apps/flinch/bus/status_line.h"
#include "apps/flinch/printing.h"
#include "drivers/wire_header.h"
#include "experiments/bus/await_robot.h"
#include "experiments/bus/link_report.h"
#include "experiments/scenario/robot_input.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/framework/constant.h"
#include "systems/framework/exchange_list.h"
#include "systems/framework/realtime_runner.h"
#include "systems/signals/sampling.h"

namespace flinch {
namespace {

constexpr Time warm_up = 300ms;

/// Reads a station and commands it nothing: no torque, brakes closed.
struct Listener {
  ExternalStation station;
  std::unique_ptr<Diagram> diagram;
};

Listener build_listener(const RobotFile& robot) {
  DiagramBuilder builder("listener", robot.control_period);
  Listener listener;
  listener.station =
      add_external_station(builder, robot.robot, {.max_age = longest_age(robot.control_period)});
  builder.connect(builder.add<Constant<TorqueCommand>>("no_torque", TorqueCommand()).value,
                  listener.station.torque_command);
  builder.connect(builder.add<Constant<BrakeCommand>>("brakes_closed", BrakeCommand()).value,
                  listener.station.brake);
  listener.diagram = builder.build();
  return listener;
}

/// What has happened since `before`.
DdsLink since(const DdsLink& before, DdsLink now) {
  now.received -= before.received;
  now.refused -= before.refused;
  now.lost -= before.lost;
  now.deadlines_missed -= before.deadlines_missed;
  return now;
}

/// Lets others see how far the loop is.
class LoopTime final : public Exchange {
 public:
  void take_outputs(const Context& context) override { time_ = context.time(); }
  Time now() const noexcept { return time_; }

 private:
  std::atomic<Time> time_ = Time::zero();
};

ExitStatus tell(const LinkReport& report, const LinkOptions& options) {
  print_result("{}", options.common.json ? report.json() + "\n" : report.table());
  return report.objections().empty() ? ExitStatus::done : ExitStatus::bad_verdict;
}

}  // namespace

ExitStatus link(const LinkOptions& options) {
  const bool silent = options.common.quiet || options.common.json;
  const RobotInput input = read_robot_input(options.robot);
  const Listener listener = build_listener(input.robot);
  const Interrupts interrupts;
  const BusSettings settings = bus_settings(options.bus, silent);
  const DdsBus bus(settings);
  DdsStation station(bus, *listener.diagram, listener.station,
                     {.robot = robot_hash(input.text),
                      .chosen_robot = options.bus.robot,
                      .realtime_priority = settings.realtime_priority});
  if (!silent) print_message("waiting for the robot, {}\n", name_of(options.bus));
  const bool decided = out_of(name_of(options.bus), [&] {
    return await_robot(station, from_seconds(options.patience), Interrupts::count);
  });
  if (!decided) {
    LinkReport undecided;
    undecided.robots = station.robots();
    return tell(undecided, options);
  }

  ClockTicks ticks;
  LoopTime time;
  ExchangeList exchange({station, time});
  RealtimeRunner warming_up(*listener.diagram, ticks, exchange);
  RealtimeRunner runner(*listener.diagram, ticks, exchange);
  runner.follow_clock();
  Context context = listener.diagram->make_context();
  const Time end = warm_up + from_seconds(options.duration);
  DdsLink before;
  {
    const StatusLine line(
        [&] {
          return RunStatus{"measuring",
                           fmt::format("{:.1f} of {:.1f} s", to_seconds(time.now()), to_seconds(end))};
        },
        silent);
    const RealtimeThread thread(loop_settings(options.bus));
    tell_what_is_missing(thread.report(), silent);
    warming_up.run(context, warm_up);
    fall_into_step(station, ticks);
    station.forget_times();
    before = station.link();
    runner.run(context, end, [] { return Interrupts::count() > 0; });
  }
  const LinkReport report{since(before, station.link()),
                          station.times(),
                          runner.statistics(),
                          see_pose(*input.robot.robot, context.get(listener.station.joints)),
                          station.robots(),
                          !options.bus.robot.empty(),
                          listener.diagram->tick()};
  return tell(report, options);
}

}  // namespace flinch
