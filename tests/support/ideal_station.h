#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

#include "systems/framework/random.h"
#include "systems/framework/system.h"
#include "systems/robot/planar_rrr.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

namespace flinch::test {

/// A wall that only pushes: the platform's origin is free up to `position` along x.
struct Wall {
  double position = 1e3;      ///< [m]
  double stiffness = 6000.0;  ///< [N/m]
};

struct IdealStationSettings {
  Eigen::Vector3d pose{0.0, 0.0, 0.0};
  Eigen::Vector3d velocity{0.0, 0.0, 0.0};
  JointVector torque_constant = JointVector::Constant(3, 6.1);  ///< [Nm/A]
  double encoder_noise = 0.0;                                   ///< standard deviation [rad]
  Wall wall;
};

/// The planar robot behind a station's ports as a block, to try controllers with: torques act at once and are
/// held from tick to tick, brakes stop everything within milliseconds, sensors are exact but for the
/// encoders' noise.
class IdealStation final : public System {
 public:
  using Motion = Eigen::Matrix<double, 6, 1>;  ///< pose, velocity

 private:
  State<Motion> motion_;
  State<TorqueCommand> torque_ = state<TorqueCommand>("torque");
  State<BrakeCommand> brake_ = state<BrakeCommand>("brake");
  State<PlatformVector> wrench_ = state<PlatformVector>("wrench");
  State<RandomGenerator> random_ = state<RandomGenerator>("random", RandomGenerator(1));

 public:
  IdealStation(std::shared_ptr<const PlanarRrr> robot, IdealStationSettings settings)
      : motion_(state<Motion>("motion", initial(settings))),
        robot_(std::move(robot)),
        settings_(std::move(settings)) {
    motion = output<&IdealStation::show>("motion", motion_);
    joints = output<&IdealStation::encode>("joints", motion_, random_, clock);
    derivative<&IdealStation::rates>(motion_, motion_, torque_, brake_, wrench_);
    contact_force = output<&IdealStation::push>("contact_force", motion_);
  }

  InputPort<TorqueCommand> torque_command = input<TorqueCommand>("torque_command");
  InputPort<BrakeCommand> brake = input<BrakeCommand>("brake");
  InputPort<PlatformVector> wrench = input<PlatformVector>("wrench");  ///< besides the wall's; empty for none

  OutputPort<Motion> motion;
  OutputPort<JointReading> joints;
  OutputPort<double> contact_force;  ///< of the wall [N]
  OutputPort<DriveReading> drives = output<&IdealStation::measure>("drives", torque_, clock);
  OutputPort<StationStatus> status = output<&IdealStation::report>("status", brake_, clock);

 private:
  Update hold_torque_ = keep(torque_, torque_command);
  Update hold_brake_ = keep(brake_, brake);
  Update hold_wrench_ = keep(wrench_, wrench);
  Update draw_ = update<&IdealStation::draw>(random_, random_);

  static Motion initial(const IdealStationSettings& settings) {
    Motion start;
    start << settings.pose, settings.velocity;
    return start;
  }

  Motion show(const Motion& now) const { return now; }
  RandomGenerator draw(RandomGenerator generator) const {
    generator();
    return generator;
  }

  double push(const Motion& now) const {
    return settings_.wall.stiffness * std::max(0.0, now[0] - settings_.wall.position);
  }

  Motion rates(const Motion& now, const TorqueCommand& held, const BrakeCommand& brakes,
               const PlatformVector& external) const {
    Motion rates;
    const Eigen::Vector3d velocity = now.tail<3>();
    if (brakes.engage) {
      rates << velocity, -1000.0 * velocity;
      return rates;
    }
    Eigen::Vector3d F = external.size() == 3 ? Eigen::Vector3d(external) : Eigen::Vector3d::Zero();
    F[0] -= push(now);
    const Eigen::Vector3d tau = held.valid ? Eigen::Vector3d(held.torque) : Eigen::Vector3d::Zero();
    rates << velocity, robot_->acceleration(robot_->motion(now.head<3>(), velocity), tau, F);
    return rates;
  }

  JointReading encode(const Motion& now, const RandomGenerator& random, Time time) const {
    const JointAngles exact =
        robot_->inverse_kinematics(PlatformVector(now.head<3>()), robot_->home_working_mode()).joints;
    RandomGenerator generator = random;
    JointVector active = exact.active;
    for (double& angle : active) angle += settings_.encoder_noise * generator.normal();
    return {time, true, true, active, exact.passive};
  }

  /// The torque of the last millisecond.
  DriveReading measure(const TorqueCommand& held, Time time) const {
    const JointVector torque = held.valid ? held.torque : JointVector::Zero(3).eval();
    return {time, true, torque.cwiseQuotient(settings_.torque_constant)};
  }

  StationStatus report(const BrakeCommand& brakes, Time time) const {
    return {.acquired = time, .valid = true, .enabled = true, .braked = brakes.engage, .fault = false};
  }

  std::shared_ptr<const PlanarRrr> robot_;
  IdealStationSettings settings_;
};

}  // namespace flinch::test
