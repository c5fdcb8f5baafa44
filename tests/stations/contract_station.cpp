#include "tests/stations/contract_station.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "diagrams/recorded_station.h"
#include "drivers/dds_server.h"
#include "drivers/dds_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/recorder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/quantity_units.h"
#include "tests/stations/contract_ends.h"
#include "tests/support/free_domain.h"

namespace flinch::test {
namespace {

constexpr std::uint32_t robot_number = 0x3333;

/// A built diagram, stepped by hand.
class Stepped {
 public:
  explicit Stepped(DiagramBuilder& builder)
      : diagram(builder.build()),
        context(diagram->make_context()),
        simulator(*diagram, std::make_unique<SundialsIntegrator>()) {}

  std::unique_ptr<Diagram> diagram;
  Context context;
  Simulator simulator;
};

StationRun run_of(const Diagram& diagram, const ControlEnd& control) {
  const auto name = [](const auto& port) {
    return port.id.owner->name() + "/" + port.id.owner->port_name(port.id);
  };
  Recorder recorder(diagram, {"station/joints", "station/drives", "station/imu", "station/status"}, 0,
                    quantity_units(*contract_robot()));
  return {.inputs = {name(control.station.torque_command), name(control.station.brake)},
          .outputs = recorder.recording().signals,
          .before = {},
          .trace = {}};
}

/// Robot and controller in one diagram.
class OneProgram {
 public:
  explicit OneProgram(RobotKind kind)
      : robot_(add_robot_end(builder_, kind)),
        control_(add_control_end(builder_, robot_.station)),
        run_(export_readings()) {}

  StationRun run(const Script& script) {
    StationRun result = run_of(*run_.diagram, control_);
    while (run_.context.time() < script.duration) {
      const Time now = run_.context.time();
      run_.context.set(control_.order, script.order(now));
      run_.context.set(robot_.damage, script.damage(now));
      run_.simulator.step(run_.context);
      result.trace.push_back(control_.see(run_.context, now));
    }
    return result;
  }
  Recording record(const Script& script) {
    Recorder recorder(*run_.diagram, {"joints", "drives", "imu", "status"},
                      static_cast<std::size_t>(script.duration / 1ms), quantity_units(*contract_robot()));
    run_.simulator.record(recorder);
    run(script);
    return recorder.recording();
  }

 private:
  DiagramBuilder& export_readings() {
    builder_.export_output("joints", robot_.station.joints);
    builder_.export_output("drives", robot_.station.drives);
    builder_.export_output("imu", robot_.station.imu);
    builder_.export_output("status", robot_.station.status);
    return builder_;
  }

  DiagramBuilder builder_{"one_program"};
  RobotEnd robot_;
  ControlEnd control_;
  Stepped run_;
};

/// The robot's end of a link.
class FarEnd {
 public:
  explicit FarEnd(const DdsBus& bus)
      : robot_(add_robot_end(builder_, RobotKind::simulated)),
        run_(export_commands()),
        server_(bus, *run_.diagram, robot_.station,
                {.robot = robot_number,
                 .longest_silence = longest_age,
                 .longest_way = longest_age,
                 .robot_name = "contract"}) {}

  void tick(const Damage& damage) {
    run_.context.set(robot_.damage, damage);
    server_.set_inputs(run_.context);
    run_.simulator.step(run_.context);
    server_.take_outputs(run_.context);
  }

 private:
  DiagramBuilder& export_commands() {
    robot_.station.torque_command = builder_.export_input("torque_command", robot_.station.torque_command);
    robot_.station.brake = builder_.export_input("brake", robot_.station.brake);
    return builder_;
  }

  DiagramBuilder builder_{"far"};
  RobotEnd robot_;
  Stepped run_;
  DdsServer server_;
};

/// The controller's end of a link.
class NearEnd {
 public:
  explicit NearEnd(const DdsBus& bus)
      : station_(add_external_station(builder_, contract_robot(),
                                      {.max_age = longest_age, .max_imu_age = longest_age})),
        control_(add_control_end(builder_, station_)),
        run_(builder_),
        dds_(bus, *run_.diagram, station_, {.robot = robot_number, .longest_silence = longest_age}) {}

  Moment tick(const Order& order) {
    const Time now = run_.context.time();
    run_.context.set(control_.order, order);
    dds_.set_inputs(run_.context);
    run_.simulator.step(run_.context);
    dds_.take_outputs(run_.context);
    return control_.see(run_.context, now);
  }
  StationRun no_run() const { return run_of(*run_.diagram, control_); }

 private:
  DiagramBuilder builder_{"near"};
  ExternalStation station_;
  ControlEnd control_;
  Stepped run_;
  DdsStation dds_;
};

/// Both ends on one thread, half a tick apart. The robot is there when it is started.
class Link {
 public:
  Moment tick(const Damage& damage, const Order& order) {
    wait_and_tick_robot(damage);
    MonotonicClock::sleep_until(due_ - 500us);
    return near_->tick(order);
  }
  void start_robot() {
    far_.reset();
    far_ = std::make_unique<FarEnd>(bus_);
  }
  void restart_controller() {
    near_.reset();
    for (Time pause{}; pause < 2 * longest_age; pause += 1ms) wait_and_tick_robot(Damage());
    near_ = std::make_unique<NearEnd>(bus_);
  }
  StationRun no_run() const { return near_->no_run(); }
  /// Whether the machine held both ends up for so long that what they said may have got too old.
  bool was_held_up() const { return longest_wait_ >= longest_age / 2; }

 private:
  void wait_and_tick_robot(const Damage& damage) {
    MonotonicClock::sleep_until(due_);
    longest_wait_ = std::max(longest_wait_, MonotonicClock::now() - due_);
    while (MonotonicClock::now() >= due_ + 1ms) due_ += 1ms;
    due_ += 1ms;
    if (far_) far_->tick(damage);
  }

  DdsBus bus_{{.domain = free_domain()}};
  std::unique_ptr<FarEnd> far_;
  std::unique_ptr<NearEnd> near_ = std::make_unique<NearEnd>(bus_);
  Time due_ = MonotonicClock::now();
  Time longest_wait_{};
};

bool all_valid(const Moment& moment) {
  return moment.joints.valid && moment.drives.valid && moment.imu.valid && moment.status.valid &&
         moment.status.enabled;
}

/// None where the machine held an end up.
std::optional<StationRun> try_dds(const Script& script) {
  Link link;
  StationRun result = link.no_run();
  for (int tick = 0; tick < 5; ++tick) result.before.push_back(link.tick(Damage(), Order()));
  link.start_robot();
  while (!all_valid(result.before.back())) {
    result.before.push_back(link.tick(Damage(), Order()));
    if (result.before.size() > 10000) throw std::runtime_error("the two ends do not find each other");
  }
  // While they found each other the robot may have obeyed us, and heard nothing for too long.
  if (result.before.back().gate.phase == GatePhase::closed) return std::nullopt;
  for (Time now = Time::zero(); now < script.duration; now += 1ms) {
    if (script.robot_restarts == now) link.start_robot();
    if (script.controller_restarts == now) link.restart_controller();
    result.trace.push_back(link.tick(script.damage(now), script.order(now)));
  }
  return link.was_held_up() ? std::nullopt : std::optional(result);
}

}  // namespace

StationRun run_simulated(const Script& script) { return OneProgram(RobotKind::simulated).run(script); }

StationRun run_mock(const Script& script) { return OneProgram(RobotKind::mock).run(script); }

StationRun run_recorded(const Script& script) {
  const Recording recording = OneProgram(RobotKind::simulated).record(script);
  DiagramBuilder builder("replay");
  const ControlEnd control = add_control_end(builder, add_recorded_station(builder, recording));
  Stepped run(builder);
  StationRun result = run_of(*run.diagram, control);
  run.context.set(control.order, script.replay_order.value_or(Order()));
  run.context.set_time(-10ms);
  while (run.context.time() < script.duration) {
    const Time now = run.context.time();
    run.simulator.step(run.context);
    (now < Time::zero() ? result.before : result.trace).push_back(control.see(run.context, now));
  }
  return result;
}

StationRun run_dds(const Script& script) {
  for (int attempt = 0; attempt < 100; ++attempt)
    if (std::optional<StationRun> result = try_dds(script)) return *std::move(result);
  throw std::runtime_error("the machine stalls");
}

}  // namespace flinch::test
