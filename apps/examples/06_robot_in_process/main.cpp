// A robot within your own program, neither simulated by flinch nor on the bus: an Exchange brings its
// readings into the diagram before each tick and takes the torques away after it.
//
//   MyRobot --readings--> guards --> control path --torque, brake--> MyRobot
//
// A robot without passive encoders says so in its reading of the joints; one without an IMU sets none.
//
// The scenario is one of those that flinch ships; the platform runs into MyRobot's wall. Start it in the root
// of the tree.
#include <cstdio>

#include "apps/examples/06_robot_in_process/my_robot.h"
#include "experiments/live/live_experiment.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/report/run_folder.h"
#include "experiments/scenario/scenario.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/exchange.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/recorder.h"
#include "systems/robot/quantity_units.h"

using namespace flinch;

namespace {

class MyExchange final : public Exchange {
 public:
  MyExchange(MyRobot& robot, const LiveExperiment& experiment)
      : robot_(robot),
        joints_(experiment.diagram->slot(experiment.station.arriving_joints)),
        drives_(experiment.diagram->slot(experiment.station.arriving_drives)),
        imu_(experiment.diagram->slot(experiment.station.arriving_imu)),
        status_(experiment.diagram->slot(experiment.station.arriving_status)),
        torque_(experiment.diagram->slot(experiment.station.torque_command)),
        brake_(experiment.diagram->slot(experiment.station.brake)) {}

  void set_inputs(Context& context) override {
    const Time now = context.time();
    const MyReadings told = robot_.read();
    ++number_;
    context[joints_] = {{now, true, true, told.active, told.passive}, 1, number_};
    context[drives_] = {{now, true, told.current}, 1, number_};
    context[imu_] = {{now, true, told.angular_velocity, told.specific_force}, 1, number_};
    context[status_] = {{now, true, true, told.braked, false}, 1, number_};  // enabled, no fault
  }

  void take_outputs(const Context& context) override {
    const bool drive = !context[brake_].engage && context[torque_].valid;
    robot_.advance(drive ? std::optional(context[torque_].torque) : std::nullopt);
  }

 private:
  MyRobot& robot_;
  Slot<Arrival<JointReading>> joints_;
  Slot<Arrival<DriveReading>> drives_;
  Slot<Arrival<ImuReading>> imu_;
  Slot<Arrival<StationStatus>> status_;
  Slot<TorqueCommand> torque_;
  Slot<BrakeCommand> brake_;
  std::uint32_t number_ = 0;
};

bool run_into_the_wall() {
  const Scenario scenario = read_scenario("apps/scenarios/platform_collision.yaml");
  const LiveExperiment experiment = build_live_experiment(scenario);
  MyRobot robot(scenario.robot.robot, scenario.control.trajectory.path->start(),
                scenario.control.drive_torque.torque_constant, scenario.control.imu_mount);
  MyExchange exchange(robot, experiment);

  ClockTicks ticks;  // beside a robot that has a clock of its own: a TickSource of yours
  RealtimeRunner runner(*experiment.diagram, ticks, exchange);
  // runner.feed_timing(experiment.tick_timing): beside a robot that does not wait for late ticks, as this
  // does
  Recorder recorder(*experiment.diagram, recorded_paths(*experiment.diagram),
                    static_cast<std::size_t>(scenario.duration / 1ms), quantity_units(*scenario.robot.robot));
  runner.record(recorder);
  Context context = experiment.diagram->make_context();
  runner.run(context, scenario.duration);

  const RunFolder own = make_run_folder("out/example_06");
  const Verdict verdict =
      conclude_run(scenario, recorder.recording(recorded_attributes(scenario, {})), "out/example_06");
  const double touched = to_seconds(robot.touched().value_or(0s));
  const double detected = verdict.detections.empty() ? 0.0 : verdict.detections.front();
  std::printf("touched at %.3f s, detected %.0f ms later, %s; fault: %s\n", touched,
              1e3 * (detected - touched), robot.touches() ? "still touching" : "removed",
              verdict.fault.empty() ? "none" : "yes");
  const bool soon = detected >= touched && detected < touched + 0.020;
  const bool is_believed = context.get(experiment.station.imu).valid &&
                           context.get(experiment.control.plausibility).imu_doubt == ImuFault::none;
  return robot.touched() && soon && !robot.touches() && verdict.fault.empty() && is_believed;
}

}  // namespace

int main() {
  try {
    return run_into_the_wall() ? 0 : 1;
  } catch (const SetupError& error) {  // says all that is wrong
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
