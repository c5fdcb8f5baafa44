#pragma once

#include <memory>

#include "systems/safety/plausibility_monitor.h"
#include "tests/support/planar_rig.h"
#include "tests/support/ticking.h"

namespace flinch::test {

/// A PlausibilityMonitor of the planar rig, alone: a test says what it is told.
struct Monitored {
  explicit Monitored(const PlausibilityLimits& limits)
      : block(builder.add<PlausibilityMonitor>("monitor", robot, limits)) {}

  std::shared_ptr<const PlanarRrr> robot = planar_rig();
  DiagramBuilder builder{"test", 1ms};
  PlausibilityMonitor& block;
  InputPort<JointReading> joints = builder.export_input("joints", block.joints);
  InputPort<DriveReading> drives = builder.export_input("drives", block.drives);
  InputPort<ImuReading> imu = builder.export_input("imu", block.imu);
  InputPort<DriveTorque> torque = builder.export_input("torque", block.torque);
  InputPort<ResetCommand> reset = builder.export_input("reset", block.reset);
  InputPort<StationStatus> station = builder.export_input("station", block.station);
  InputPort<PlatformMotion> platform = builder.export_input("platform", block.platform);
  InputPort<Kinematics> kinematics = builder.export_input("kinematics", block.kinematics);
  InputPort<Dynamics> dynamics = builder.export_input("dynamics", block.dynamics);
  InputPort<TorqueCommand> commanded = builder.export_input("commanded", block.commanded);
  InputPort<BrakeCommand> brake = builder.export_input("brake", block.brake);
  InputPort<GateStatus> gate = builder.export_input("gate", block.gate);
  Ticking ticking{builder};
};

}  // namespace flinch::test
