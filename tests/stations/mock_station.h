#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <utility>

#include "diagrams/station.h"
#include "plant/simulated_imu.h"
#include "systems/framework/diagram_builder.h"
#include "systems/robot/planar_rrr.h"

namespace flinch::test {

/// The least that can be called a robot: three flywheels of 0.6 kg m^2 with brakes that hold at once, joined
/// by a platform without mass. Sensors are exact and at once.
class MockRobot final : public System {
 public:
  struct Motion {
    JointVector position;
    JointVector velocity = JointVector::Zero(3);
    JointVector current = JointVector::Zero(3);  ///< of the last millisecond
    PlatformVector pose = PlatformVector::Zero(3);
    bool braked = true;
  };

 private:
  State<Motion> motion_;

 public:
  MockRobot(std::shared_ptr<const PlanarRrr> robot, const JointVector& torque_constant, Time longest_silence)
      : motion_(state<Motion>("motion", at_home(*robot))),
        robot_(std::move(robot)),
        torque_constant_(torque_constant),
        longest_silence_(longest_silence) {
    joints = output<&MockRobot::encode>("joints", clock, motion_);
    drives = output<&MockRobot::measure>("drives", clock, motion_);
    imu = output<&MockRobot::feel>("imu", clock);
    status = output<&MockRobot::report>("status", clock, motion_);
    update<&MockRobot::move>(motion_, motion_, clock, torque_command, brake);
  }

  InputPort<TorqueCommand> torque_command = input<TorqueCommand>("torque_command");
  InputPort<BrakeCommand> brake = input<BrakeCommand>("brake");
  OutputPort<JointReading> joints;
  OutputPort<DriveReading> drives;
  OutputPort<ImuReading> imu;
  OutputPort<StationStatus> status;

 private:
  static Motion at_home(const PlanarRrr& robot) {
    Motion motion;
    motion.position = robot.inverse_kinematics(motion.pose, robot.home_working_mode()).joints.active;
    return motion;
  }
  JointReading encode(Time now, const Motion& motion) const {
    const InverseSolution inverse = robot_->inverse_kinematics(motion.pose, robot_->home_working_mode());
    return {now, true, true, motion.position, inverse.joints.passive};
  }
  DriveReading measure(Time now, const Motion& motion) const { return {now, true, motion.current}; }
  /// It hardly moves: mounted as on the rig, it feels the ground.
  ImuReading feel(Time now) const {
    const Eigen::Vector3d angles = SimulatedImuSettings().angles;
    const Eigen::Matrix3d platform_from_imu = (Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitX()) *
                                               Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
                                               Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitZ()))
                                                  .toRotationMatrix();
    return {now, true, Eigen::Vector3d::Zero(), platform_from_imu.transpose() * -robot_->gravity()};
  }
  StationStatus report(Time now, const Motion& motion) const {
    return {.acquired = now, .valid = true, .enabled = true, .braked = motion.braked, .fault = false};
  }
  Motion move(const Motion& last, Time now, const TorqueCommand& command, const BrakeCommand& brakes) const {
    Motion next = last;
    const Time age = now - command.computed;
    const bool usable = command.valid && command.torque.size() == 3 && command.torque.allFinite() &&
                        age >= Time::zero() && age <= longest_silence_;
    next.braked = brakes.engage || !usable;
    next.current.setZero(3);
    if (next.braked) {
      next.velocity.setZero(3);
      return next;
    }
    next.current = command.torque.cwiseQuotient(torque_constant_);
    next.velocity += 1e-3 / 0.6 * command.torque;
    next.position += 1e-3 * next.velocity;
    const ForwardSolution solution =
        robot_->forward_kinematics(next.position, last.pose, robot_->home_working_mode());
    if (solution.converged) next.pose = solution.pose;
    return next;
  }

  std::shared_ptr<const PlanarRrr> robot_;
  JointVector torque_constant_;
  Time longest_silence_;
};

/// Adds it as a station.
inline Station add_mock_station(DiagramBuilder& builder, const std::shared_ptr<const PlanarRrr>& robot,
                                const JointVector& torque_constant, Time longest_silence) {
  DiagramBuilder inside("station");
  auto& mock = inside.add<MockRobot>("robot", robot, torque_constant, longest_silence);
  Station station{.torque_command = inside.export_input("torque_command", mock.torque_command),
                  .brake = inside.export_input("brake", mock.brake),
                  .joints = inside.export_output("joints", mock.joints),
                  .drives = inside.export_output("drives", mock.drives),
                  .imu = inside.export_output("imu", mock.imu),
                  .status = inside.export_output("status", mock.status),
                  .force_torque = std::nullopt};
  builder.add(inside.build());
  return station;
}

}  // namespace flinch::test
