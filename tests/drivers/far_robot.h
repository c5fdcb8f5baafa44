#pragma once

#include <memory>

#include "diagrams/station.h"
#include "systems/framework/diagram_builder.h"

/// A robot for the far end of a link, whose every value tells where it comes from.
namespace flinch::test {

/// At t: active angles t (1, 2, 3) [s -> rad], passive ones t (4, 5, 6); currents: the last torques obeyed,
/// over ten; angular velocity t (1, 1, 1); enabled, and braked as long as no valid command comes without
/// brakes.
class FarRobot final : public System {
  State<TorqueCommand> obeyed_ = state<TorqueCommand>("obeyed");
  State<BrakeCommand> brake_ = state<BrakeCommand>("brake");

 public:
  InputPort<TorqueCommand> torque_command = input<TorqueCommand>("torque_command");
  InputPort<BrakeCommand> brake = input<BrakeCommand>("brake");
  OutputPort<JointReading> joints = output<&FarRobot::encode>("joints", clock);
  OutputPort<DriveReading> drives = output<&FarRobot::measure>("drives", clock, obeyed_);
  OutputPort<ImuReading> imu = output<&FarRobot::turn>("imu", clock);
  OutputPort<StationStatus> status = output<&FarRobot::report>("status", clock, obeyed_, brake_);

 private:
  Update obey_ = keep(obeyed_, torque_command);
  Update close_ = keep(brake_, brake);

  static JointVector spread(Time now, double first) {
    return to_seconds(now) * JointVector::LinSpaced(3, first, first + 2.0);
  }
  JointReading encode(Time now) const {
    return {.acquired = now,
            .valid = true,
            .passive_valid = true,
            .active = spread(now, 1.0),
            .passive = spread(now, 4.0)};
  }
  DriveReading measure(Time now, const TorqueCommand& obeyed) const {
    const JointVector torque = obeyed.valid ? obeyed.torque : JointVector(JointVector::Zero(3));
    return {.acquired = now, .valid = true, .current = torque / 10.0};
  }
  ImuReading turn(Time now) const {
    return {.acquired = now,
            .valid = true,
            .angular_velocity = Eigen::Vector3d::Constant(to_seconds(now)),
            .specific_force = {0.0, 0.0, 9.81}};
  }
  StationStatus report(Time now, const TorqueCommand& obeyed, const BrakeCommand& brakes) const {
    return {.acquired = now,
            .valid = true,
            .enabled = true,
            .braked = brakes.engage || !obeyed.valid,
            .fault = false};
  }
};

/// What commands it: torques that follow the active angles it reads, without brakes, once the station is
/// enabled.
class NearController final : public System {
 public:
  InputPort<JointReading> joints = input<JointReading>("joints");
  InputPort<StationStatus> status = input<StationStatus>("status");
  OutputPort<TorqueCommand> torque_command =
      output<&NearController::follow>("torque_command", clock, joints, status);
  OutputPort<BrakeCommand> brake = output<&NearController::release>("brake", torque_command);

 private:
  TorqueCommand follow(Time now, const JointReading& angles, const StationStatus& station) const {
    if (!angles.valid || !station.valid || !station.enabled)
      return {.computed = now, .valid = false, .torque = {}};
    return {.computed = now, .valid = true, .torque = angles.active};
  }
  BrakeCommand release(const TorqueCommand& command) const { return {.engage = !command.valid}; }
};

}  // namespace flinch::test
