#pragma once

#include <functional>

#include "systems/framework/random.h"
#include "systems/safety/plausibility_monitor.h"
#include "tests/systems/safety/monitored.h"

namespace flinch::test {

inline constexpr double angle_noise = 7e-6;    ///< [rad]
inline constexpr double current_noise = 0.01;  ///< [A]

inline PlausibilityLimits watched_limits() {
  PlausibilityLimits limits;
  limits.torque_constant = Eigen::Vector3d::Constant(6.0);
  return limits;
}

/// What a tick is told; that of a robot at rest at home with all sensors, unless a test changes it.
struct Told {
  JointReading joints;
  DriveReading drives;
  ImuReading imu;
  StationStatus station;
  TorqueCommand command;
  BrakeCommand brake{.engage = false};
  GateStatus gate{.phase = GatePhase::open, .reaction = GateReaction::none};
};

/// The monitor before a robot that stands still while its brakes hold it, then without for 60 ms.
class Watched {
 public:
  /// `always`: what each tick is told otherwise than by an honest robot with all sensors.
  explicit Watched(
      std::function<void(Told&)> always = [](Told&) {}, const PlausibilityLimits& limits = watched_limits(),
      int held_ticks = 200)
      : monitor_(limits), always_(std::move(always)) {
    for (int k = 0; k < held_ticks; ++k) tick(held);
    for (int k = 0; k < 60; ++k) tick();
  }

  static void held(Told& told) {
    told.station.braked = told.brake.engage = true;
    told.command.valid = false;
  }

  const Plausibility& tick(const std::function<void(Told&)>& change = [](Told&) {}) {
    Told told = healthy();
    always_(told);
    change(told);
    monitor_.ticking.set(monitor_.joints, told.joints);
    monitor_.ticking.set(monitor_.drives, told.drives);
    monitor_.ticking.set(monitor_.imu, told.imu);
    monitor_.ticking.set(monitor_.torque, DriveTorque());
    monitor_.ticking.set(monitor_.reset, ResetCommand());
    monitor_.ticking.set(monitor_.station, told.station);
    monitor_.ticking.set(monitor_.platform, posture_.platform);
    monitor_.ticking.set(monitor_.kinematics, posture_.kinematics);
    monitor_.ticking.set(monitor_.dynamics, posture_.dynamics);
    monitor_.ticking.set(monitor_.commanded, told.command);
    monitor_.ticking.set(monitor_.brake, told.brake);
    monitor_.ticking.set(monitor_.gate, told.gate);
    monitor_.ticking.tick();
    return monitor_.ticking.get(monitor_.block.plausibility);
  }

  int ticks() const { return static_cast<int>(monitor_.ticking.now() / 1ms); }

 private:
  double noise(double deviation) { return deviation * random_.normal(); }

  Told healthy() {
    Told told;
    const Time now = monitor_.ticking.now();
    posture_ = Posture(*monitor_.robot, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), now);
    told.joints = posture_.joints;
    for (double& angle : told.joints.active) angle += noise(angle_noise);
    told.drives.acquired = told.station.acquired = told.command.computed = told.imu.acquired = now;
    told.drives.valid = told.station.valid = told.station.enabled = told.command.valid = told.imu.valid =
        true;
    told.drives.current.setZero(3);
    for (double& current : told.drives.current) current += noise(current_noise);
    told.command.torque.setZero(3);
    told.imu.specific_force = -monitor_.robot->gravity();
    for (double& rate : told.imu.angular_velocity) rate += noise(1e-3);
    return told;
  }

  Monitored monitor_;
  std::function<void(Told&)> always_;
  RandomGenerator random_{1};
  Posture posture_{*monitor_.robot};
};

}  // namespace flinch::test
