#pragma once

#include <memory>

#include "systems/framework/diagram_builder.h"
#include "systems/safety/fault_monitor.h"
#include "systems/safety/torque_gate.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch::test {

/// All that monitor and gate see at a tick. Healthy by default: the rig at rest at home.
struct Inputs {
  Inputs(const ParallelRobot& robot, Time tick)
      : now(tick), posture(robot, PlatformVector::Zero(3), PlatformVector::Zero(3), now) {
    const JointVector zero = JointVector::Zero(3);
    posture.joints.active.array() += encoder_noise(now);
    station = {.acquired = now, .valid = true, .enabled = true, .braked = false, .fault = false};
    drives = {.acquired = now, .valid = true, .current = zero};
    detection = {.valid = true, .wrench_in_base = {}};
    reference = {true, true, posture.platform.pose, zero, zero};
    command = {.computed = now, .valid = true, .torque = zero};
  }

  /// Never the same in two ticks that follow each other [rad].
  static double encoder_noise(Time tick) { return 1e-6 * static_cast<double>(1 + tick / 1ms % 7); }

  Time now;
  TickTiming timing;
  Posture posture;
  StationStatus station;
  DriveReading drives;
  ContactDetection detection;
  PlatformReference reference;
  TorqueCommand command;
  OperatorCommand buttons;
  ReactionState reaction{.mode = ReactionMode::nominal, .previous = ReactionMode::stopped, .since = {}};
  Plausibility plausibility{.valid = true};
  DriveCheckStatus drive_check;
  Time last_seen = 10ms;  ///< for what hangs: the last tick of open()
};

/// Fault monitor and torque gate, wired as in the pipeline.
struct Safety {
  void tick(const Inputs& inputs, bool reset_now = false) {
    ticking.set(timing, inputs.timing);
    ticking.set(station, inputs.station);
    ticking.set(joints, inputs.posture.joints);
    ticking.set(drives, inputs.drives);
    ticking.set(motion, inputs.posture.motion);
    ticking.set(platform, inputs.posture.platform);
    ticking.set(measures, inputs.posture.measures);
    ticking.set(detection, inputs.detection);
    ticking.set(reference, inputs.reference);
    ticking.set(command, inputs.command);
    ticking.set(buttons, inputs.buttons);
    ticking.set(reaction, inputs.reaction);
    ticking.set(plausibility, inputs.plausibility);
    ticking.set(drive_check, inputs.drive_check);
    ticking.set(stop, {.computed = ticking.now(), .valid = true, .torque = Eigen::Vector3d(7.0, 8.0, 9.0)});
    ticking.set(reset, {.reset = reset_now});
    ticking.tick();
  }
  void tick(bool reset_now = false) { tick(Inputs(*robot, ticking.now()), reset_now); }
  FaultMask present() const { return ticking.get(monitor.faults).present; }
  const GateStatus& status() const { return ticking.get(gate.status); }

  std::shared_ptr<const PlanarRrr> robot = planar_rig();
  FaultLimits limits = {};
  DiagramBuilder builder{};
  FaultMonitor& monitor = builder.add<FaultMonitor>("monitor", robot, limits);
  TorqueGate& gate =
      builder.add<TorqueGate>("gate", TorqueGateSettings{.max_torque = 100.0, .max_torque_rate = 1e9});
  InputPort<TorqueCommand> command = connect();
  InputPort<TickTiming> timing = builder.export_input("timing", monitor.timing);
  InputPort<StationStatus> station = builder.export_input("station", monitor.station);
  InputPort<JointReading> joints = builder.export_input("joints", monitor.joints);
  InputPort<DriveReading> drives = builder.export_input("drives", monitor.drives);
  InputPort<JointMotion> motion = builder.export_input("motion", monitor.motion);
  InputPort<PlatformMotion> platform = builder.export_input("platform", monitor.platform);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", monitor.kinematics);
  InputPort<WorkspaceMeasures> measures = builder.export_input("measures", monitor.measures);
  InputPort<ContactDetection> detection = builder.export_input("detection", monitor.detection);
  InputPort<PlatformReference> reference = builder.export_input("reference", monitor.reference);
  InputPort<OperatorCommand> buttons = builder.export_input("buttons", monitor.buttons);
  InputPort<ReactionState> reaction = builder.export_input("reaction", monitor.reaction);
  InputPort<Plausibility> plausibility = builder.export_input("plausibility", monitor.plausibility);
  InputPort<DriveCheckStatus> drive_check = builder.export_input("drive_check", monitor.drive_check);
  InputPort<TorqueCommand> stop = builder.export_input("stop", gate.stop);
  InputPort<ResetCommand> reset = builder.export_input("reset", gate.reset);
  Ticking ticking{builder};

 private:
  InputPort<TorqueCommand> connect() {
    const auto asked = builder.export_input("command", monitor.command);
    builder.connect(asked, gate.command);
    builder.connect(monitor.faults, gate.faults);
    return asked;
  }
};

}  // namespace flinch::test
