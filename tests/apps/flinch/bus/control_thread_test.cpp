// What the thread that commands a robot on the bus may not do, shown by standing before the functions in
// question.
#include <gtest/gtest.h>

#include <functional>

#include "drivers/event_publisher.h"
#include "drivers/ros2_publisher.h"
#include "drivers/wire_header.h"
#include "experiments/bus/operator_panel.h"
#include "experiments/live/live_experiment.h"
#include "experiments/scenario/scenario.h"
#include "systems/framework/exchange_list.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/realtime_thread.h"
#include "systems/framework/recorder.h"
#include "systems/robot/quantity_units.h"
#include "tests/apps/flinch/bus/dds_calls.h"
#include "tests/apps/flinch/bus/rig_on_the_bus.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"
#include "tests/support/sanitized.h"

namespace flinch {
namespace {

TEST(ControlThread, TakesNoMemoryAndNoLockAndNeverCallsTheBus) {
  if (test::sanitized()) GTEST_SKIP() << "a sanitizer replaces what is counted here";
  const test::RigOnTheBus rig;
  const Scenario scenario = read_scenario(rig.scenario_file);
  const LiveExperiment experiment = build_live_experiment(scenario);
  const int priority = permits_realtime(80) ? 80 : 0;
  const DdsBus bus({.domain = static_cast<std::uint32_t>(std::stoul(rig.domain)),
                    .interface = "lo",
                    .peers = {},
                    .realtime_priority = priority});
  DdsStation station(bus, *experiment.diagram, experiment.station,
                     {.robot = robot_hash(scenario.robot_text), .realtime_priority = priority});
  OperatorPanel panel(experiment, scenario.control, station, no_interrupts);
  Ros2Publisher ros2(bus, *experiment.diagram,
                     {.joint_motion = experiment.control.joint_motion,
                      .drive_torque = experiment.control.drive_torque,
                      .imu = experiment.station.imu,
                      .wrench = experiment.control.wrench_estimate,
                      .gate = experiment.control.gate},
                     {.joint_names = {"a", "b", "c"}, .space = scenario.robot.robot->space()});
  EventPublisher events(bus, *experiment.diagram,
                        {.detection = experiment.control.detection,
                         .reaction = experiment.control.reaction_state,
                         .gate = experiment.control.gate,
                         .timing = experiment.tick_timing,
                         .links = {experiment.station.joints_link}},
                        {});
  ExchangeList exchange({station, panel, ros2, events});
  ClockTicks ticks;
  RealtimeRunner runner(*experiment.diagram, ticks, exchange);
  Recorder recorder(*experiment.diagram, recordable_paths(*experiment.diagram), 4000,
                    quantity_units(*scenario.robot.robot));
  runner.record(recorder);
  runner.follow_clock();
  runner.feed_timing(experiment.tick_timing);
  Context context = experiment.diagram->make_context();
  bool opened = false;
  const PlatformVector step = PlatformVector::Constant(scenario.robot.robot->dof(), 1e-3);
  const std::function<bool()> enabled = [&] { return station.link().enabled; };
  const std::function<bool()> watch_the_gate = [&] {
    const bool is_open = context.get(experiment.control.gate).phase == GatePhase::open;
    if (is_open && !opened) {  // a step is planned in the loop; the queue is of this thread here
      panel.orders().give(
          {.buttons = {}, .target = {.kind = TargetCommand::Kind::step, .pose = {}, .step = step}});
      panel.orders().give({.buttons = {.reset = true}, .target = {}});
    }
    opened |= is_open;
    return false;
  };
  const RealtimeThread thread{RealtimeSettings()};
  runner.run(context, 100ms);

  std::int64_t called = 0, locked = 0, allocated = 0;
  for (int attempt = 0; attempt < 5 && !opened; ++attempt) {  // a busy machine may let the robot give us up
    station.request({.state = RequestedDriveState::State::operation_enabled, .engage_brake = false});
    panel.release_stop();
    const std::int64_t calls = test::dds_calls(), locks = test::locks(), allocations = test::allocations();
    runner.run(context, context.time() + 10s, enabled);
    runner.run(context, context.time() + 600ms, watch_the_gate);
    called += test::dds_calls() - calls;
    locked += test::locks() - locks;
    allocated += test::allocations() - allocations;
  }
  EXPECT_EQ(allocated, 0);
  EXPECT_EQ(locked, 0);
  EXPECT_EQ(called, 0);
  EXPECT_TRUE(opened) << "the loop has not commanded anything";
}

TEST(ControlThread, IsWatchedByCountersThatCount) {
  if (test::sanitized()) GTEST_SKIP() << "a sanitizer replaces what is counted here";
  const test::RigOnTheBus rig;
  const Scenario scenario = read_scenario(rig.scenario_file);
  const LiveExperiment experiment = build_live_experiment(scenario);
  const DdsBus bus({.domain = static_cast<std::uint32_t>(std::stoul(rig.domain))});
  const DdsStation station(bus, *experiment.diagram, experiment.station, {});
  const std::int64_t calls = test::dds_calls(), locks = test::locks();
  EXPECT_GE(station.peers(), 0);
  EXPECT_GT(test::dds_calls(), calls);
  EXPECT_GT(test::locks(), locks);
}

}  // namespace
}  // namespace flinch
