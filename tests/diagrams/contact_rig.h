#pragma once

#include <memory>
#include <numbers>

#include "diagrams/contact_control.h"
#include "diagrams/operator_ports.h"
#include "systems/framework/runge_kutta.h"
#include "systems/framework/simulator.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/ideal_station.h"

namespace flinch::test {

inline constexpr double encoder_noise = 4e-4 * std::numbers::pi / 180.0;  // [RAL25] IV-A

struct RigExperiment {
  RigFriction friction = RigFriction::none;
  IdealStationSettings station;
  ContactControlSettings control;
  OperatorScript script;
};

/// The pipeline around an ideal station, run by hand: what the operator and an external wrench do is set
/// between ticks.
class Bench {
 public:
  explicit Bench(const RigExperiment& experiment)
      : robot(std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, experiment.friction))),
        station(builder_.add<IdealStation>("station", robot, experiment.station)),
        control(add_contact_control(builder_, robot, experiment.control)),
        joints_(builder_.add<Dropout>("dropout")),
        panel_(add_operator(builder_, control, experiment.script)),
        timing_(builder_.export_input("tick_timing", control.tick_timing)),
        wrench_(builder_.export_input("wrench", station.wrench)),
        broken_(builder_.export_input("broken", joints_.broken)),
        diagram(build()),
        context(diagram->make_context()),
        simulator_(*diagram, std::make_unique<RungeKutta>(4)) {
    context.set(panel_.buttons, {});
    context.set(wrench_, PlatformVector());
    context.set(broken_, false);
  }

  void press(const OperatorCommand& buttons) { context.set(panel_.buttons, buttons); }
  /// One press of the reset button.
  void reset() {
    press({.start = false, .reset = true});
    tick();
    press({});
  }
  void go_to(const Configuration& pose) {
    wanted_ = {.number = wanted_.number + 1, .kind = TargetCommand::Kind::pose, .pose = pose, .step = {}};
    context.set(panel_.target, wanted_);
  }
  void push(const PlatformVector& wrench) { context.set(wrench_, wrench); }
  void lose_encoders(bool lost) { context.set(broken_, lost); }

  void tick() { simulator_.step(context); }
  template <class See>
  void run(Time duration, See see) {
    for (const Time end = context.time() + duration; context.time() < end;) {
      tick();
      see();
    }
  }
  void run(Time duration) {
    run(duration, [] {});
  }
  /// Runs until the mode is reached; false if it is not within `limit`.
  bool run_until(ReactionMode mode, Time limit) {
    for (const Time end = context.time() + limit; context.time() < end;) {
      tick();
      if (state().mode == mode) return true;
    }
    return false;
  }

  const ReactionState& state() const { return context.get(control.reaction_state); }
  const GateStatus& gate() const { return context.get(control.gate); }
  const TorqueCommand& torque() const { return context.get(control.torque_command); }
  Eigen::Vector3d pose() const { return context.get(station.motion).head<3>(); }
  Eigen::Vector3d velocity() const { return context.get(station.motion).tail<3>(); }

 private:
  /// Loses joint readings while `broken`.
  class Dropout final : public System {
   public:
    InputPort<JointReading> in = input<JointReading>("in");
    InputPort<bool> broken = input<bool>("broken");
    OutputPort<JointReading> out = output<&Dropout::pass>("out", in, broken);

   private:
    void pass(const JointReading& reading, bool lost, JointReading& result) const {
      result = reading;
      if (lost) result.valid = false;
    }
  };

  std::unique_ptr<Diagram> build() {
    builder_.connect(station.joints, joints_.in);
    builder_.connect(joints_.out, control.joints);
    builder_.connect(station.drives, control.drives);
    builder_.connect(station.status, control.status);
    builder_.connect(control.torque_command, station.torque_command);
    builder_.connect(control.brake, station.brake);
    return builder_.build();
  }

  DiagramBuilder builder_{"bench"};

 public:
  std::shared_ptr<const PlanarRrr> robot;
  IdealStation& station;
  ContactControl control;

 private:
  Dropout& joints_;
  OperatorPorts panel_;
  TargetCommand wanted_;
  InputPort<TickTiming> timing_;
  InputPort<PlatformVector> wrench_;
  InputPort<bool> broken_;

 public:
  std::unique_ptr<Diagram> diagram;
  Context context;

 private:
  Simulator simulator_;
};

/// Into a wall of 6 kN/m, 0.05 m behind the middle of a passage at `speed`.
inline RigExperiment collision(double speed) {
  RigExperiment experiment;
  experiment.friction = RigFriction::test_rig;
  experiment.station.encoder_noise = encoder_noise;
  const PlanarRrr robot(rig_robot(RigGeometry::individual, experiment.friction));
  const Passage passing = passage(robot, {.pose = Eigen::Vector3d(0.05, 0.0, 0.0),
                                          .direction = Eigen::Vector2d(1.0, 0.0),
                                          .speed = speed,
                                          .cruise = 0.05});
  experiment.station.pose = passing.path.start();
  experiment.station.wall = {.position = 0.05, .stiffness = 6000.0};
  experiment.control.trajectory.path = passing.path;
  experiment.control.trajectory.start = 300ms;
  return experiment;
}

}  // namespace flinch::test
