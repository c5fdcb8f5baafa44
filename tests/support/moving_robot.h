#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/system.h"
#include "systems/framework/zero_order_hold.h"
#include "systems/robot/planar_rrr.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/joint_reading.h"
#include "tests/support/smooth_trajectory.h"

/// A simulated planar robot to try blocks with, driven along SmoothTrajectory: exact sensors, ideal drives.
namespace flinch::test {

using PlanarState = Eigen::Matrix<double, 6, 1>;  ///< pose, velocity

/// The robot, and its exact sensors.
class PlanarPlant final : public System {
  State<PlanarState> state_;

 public:
  explicit PlanarPlant(std::shared_ptr<const PlanarRrr> robot) : robot_(std::move(robot)) {
    const SmoothTrajectory start(0.0);
    PlanarState initial;
    initial << start.pose, start.velocity;
    state_ = System::state<PlanarState>("state", initial);
    state = output<&PlanarPlant::read>("state", state_);
    joints = output<&PlanarPlant::encode>("joints", state_, clock);
    drives = output<&PlanarPlant::measure>("drives", torque, clock);
    derivative<&PlanarPlant::rates>(state_, state_, torque, wrench);
  }

  InputPort<JointVector> torque = input<JointVector>("torque");
  InputPort<PlatformVector> wrench = input<PlatformVector>("wrench");
  OutputPort<PlanarState> state;
  OutputPort<JointReading> joints;
  OutputPort<DriveReading> drives;  ///< with torque constants of 1 Nm/A

 private:
  PlanarState read(const PlanarState& now) const { return now; }

  PlanarState rates(const PlanarState& now, const JointVector& drive_torque,
                    const PlatformVector& external) const {
    const PlanarMotion motion = robot_->motion(now.head<3>(), now.tail<3>());
    const Eigen::Vector3d tau =
        drive_torque.size() == 3 ? Eigen::Vector3d(drive_torque) : Eigen::Vector3d::Zero();
    const Eigen::Vector3d F = external.size() == 3 ? Eigen::Vector3d(external) : Eigen::Vector3d::Zero();
    PlanarState rates;
    rates << now.tail<3>(), robot_->acceleration(motion, tau, F);
    return rates;
  }

  JointReading encode(const PlanarState& now, Time time) const {
    const auto mode = robot_->home_working_mode();
    const JointAngles joint = robot_->inverse_kinematics(PlatformVector(now.head<3>()), mode).joints;
    return {time, true, true, joint.active, joint.passive};
  }

  // The torque that has been held since the last tick; before the first there is none.
  DriveReading measure(const JointVector& drive_torque, Time time) const {
    return {time, drive_torque.size() == 3, drive_torque};
  }

  std::shared_ptr<const PlanarRrr> robot_;
};

/// Torques that keep the robot on the trajectory: the model's, and a spring and damper against what they
/// miss.
class TrajectoryController final : public System {
 public:
  explicit TrajectoryController(std::shared_ptr<const ParallelRobot> robot) : robot_(std::move(robot)) {}

  InputPort<PlanarState> state = input<PlanarState>("state");
  OutputPort<JointVector> torque = output<&TrajectoryController::control>("torque", state, clock);

 private:
  JointVector control(const PlanarState& now, Time time) const {
    const SmoothTrajectory wanted(to_seconds(time));
    Kinematics kinematics;
    Dynamics dynamics;
    robot_->kinematics(wanted.pose, wanted.velocity, kinematics);
    robot_->dynamics(kinematics, dynamics);
    const Eigen::Vector3d feedback =
        2500.0 * (wanted.pose - now.head<3>()) + 100.0 * (wanted.velocity - now.tail<3>());
    const PlatformVector F_a = dynamics.M_x * PlatformVector(wanted.acceleration + feedback) +
                               dynamics.C_x * PlatformVector(wanted.velocity) + dynamics.F_fr_x;
    return drive_torques(kinematics, F_a);
  }

  std::shared_ptr<const ParallelRobot> robot_;
};

/// A constant wrench from `begin` on.
class Push final : public System {
 public:
  Push(PlatformVector constant, Time begin) : wrench_(std::move(constant)), begin_(begin) {}
  OutputPort<PlatformVector> wrench = output<&Push::push>("wrench", clock);

 private:
  PlatformVector push(Time now) const {
    return now >= begin_ ? wrench_ : PlatformVector::Zero(wrench_.size());
  }
  PlatformVector wrench_;
  Time begin_;
};

/// The plant in a loop with its controller, pushed by a wrench, in `builder`. Torque and wrench are held from
/// tick to tick, so that the drive reading at a tick tells the torque since the last one.
inline PlanarPlant& add_moving_robot(DiagramBuilder& builder, const std::shared_ptr<const PlanarRrr>& robot,
                                     const PlatformVector& wrench, Time begin) {
  auto& plant = builder.add<PlanarPlant>("plant", robot);
  auto& controller = builder.add<TrajectoryController>("controller", robot);
  auto& held_torque = builder.add<ZeroOrderHold<JointVector>>("held_torque");
  auto& push = builder.add<Push>("push", wrench, begin);
  auto& held_push = builder.add<ZeroOrderHold<PlatformVector>>("held_push");
  builder.connect(plant.state, controller.state);
  builder.connect(controller.torque, held_torque.input);
  builder.connect(held_torque.held, plant.torque);
  builder.connect(push.wrench, held_push.input);
  builder.connect(held_push.held, plant.wrench);
  return plant;
}

}  // namespace flinch::test
