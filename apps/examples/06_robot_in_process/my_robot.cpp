#include "apps/examples/06_robot_in_process/my_robot.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "systems/robot/imu_output.h"

using namespace flinch;

MyRobot::MyRobot(std::shared_ptr<const ParallelRobot> robot, Configuration pose, JointVector torque_constant,
                 const MountedImu& imu)
    : robot_(std::move(robot)),
      pose_(std::move(pose)),
      velocity_(PlatformVector::Zero(robot_->dof())),
      acceleration_(velocity_),
      torque_constant_(std::move(torque_constant)),
      torque_(JointVector::Zero(robot_->drives())),
      imu_(imu) {}

/// Of a wall at x = -60 mm, 6 N/mm.
double MyRobot::wall_force() const { return std::max(0.0, 6000.0 * (-0.060 - pose_[0])); }

MyReadings MyRobot::read() const {
  const JointAngles angles = robot_->inverse_kinematics(pose_, robot_->home_working_mode()).joints;
  const ImuOutput imu = imu_output(robot_->space(), imu_, robot_->gravity(), pose_, velocity_, acceleration_);
  return {.active = angles.active,
          .passive = angles.passive,
          .current = torque_.cwiseQuotient(torque_constant_),
          .angular_velocity = imu.value.head<3>(),
          .specific_force = imu.value.tail<3>(),
          .braked = braked_};
}

// Semi-implicit Euler: M dv/dt = F_a + F_ext - C v - g - F_fr.
void MyRobot::advance(const std::optional<JointVector>& torque) {
  braked_ = !torque;
  torque_ = torque.value_or(JointVector::Zero(robot_->drives()));
  constexpr int steps = 20;
  constexpr double step = 1e-3 / steps;
  for (int i = 0; i < steps && !braked_; ++i) {
    Kinematics at;
    Dynamics model;
    robot_->kinematics(pose_, velocity_, at);
    robot_->dynamics(at, model);
    PlatformVector force = at.J_qa_x.transpose() * torque_ - model.C_x * velocity_ - model.g_x - model.F_fr_x;
    force[0] += wall_force();
    acceleration_ = model.M_x.llt().solve(force);
    velocity_ += step * acceleration_;
    pose_ = robot_->space().plus(pose_, step * velocity_);
  }
  if (braked_) velocity_ = acceleration_ = PlatformVector::Zero(robot_->dof());
  time_ += 1ms;
  if (touches() && !touched_) touched_ = time_;
}
