#pragma once

#include <cmath>
#include <memory>

#include "plant/plant_truth.h"
#include "systems/framework/system.h"
#include "systems/robot/mechanism.h"
#include "systems/signals/torque_command.h"

namespace flinch::test {

/// Where a servo shall take the platform: from the home pose towards and around on smooth paths.
struct Path {
  Eigen::Vector3d centre{0.0, 0.0, 0.0};
  Eigen::Vector3d amplitude{0.12, 0.10, 0.12};  ///< [m, m, rad]
  Eigen::Vector3d frequency{5.0, 4.0, 3.0};     ///< [rad/s]

  Eigen::Vector3d at(double t) const {
    return centre + Eigen::Vector3d(amplitude[0] * std::sin(frequency[0] * t),
                                    amplitude[1] * (1.0 - std::cos(frequency[1] * t)),
                                    amplitude[2] * std::sin(frequency[2] * t));
  }
};

/// Law that moves the platform along a path: F = K (x_d - x) - D v, tau_a = J_x,qa^T F.
class Servo {
 public:
  Servo(const std::shared_ptr<const Mechanism>& robot, const Path& path) : robot_(robot), path_(path) {}

  /// Drive torques [Nm] at the time `t` [s]; none near a singularity.
  Eigen::Vector3d torque(double t, const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) const {
    Kinematics kinematics;
    robot_->kinematics(pose, velocity, kinematics);
    if (!kinematics.valid) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d error = robot_->difference(path_.at(t), pose);
    const Eigen::Vector3d force = stiffness_.cwiseProduct(error) - damping_.cwiseProduct(velocity);
    return kinematics.J_x_qa.transpose() * force;
  }

 private:
  std::shared_ptr<const Mechanism> robot_;
  Path path_;
  Eigen::Vector3d stiffness_{2000.0, 2000.0, 85.0};
  Eigen::Vector3d damping_{170.0, 170.0, 4.0};
};

/// The same as a block that knows the truth.
class TruthServo final : public System {
 public:
  TruthServo(const std::shared_ptr<const Mechanism>& robot, const Path& path) : servo_(robot, path) {}

  InputPort<PlantTruth> truth = input<PlantTruth>("truth");
  OutputPort<TorqueCommand> torque = output<&TruthServo::control>("torque", clock, truth);

 private:
  void control(Time now, const PlantTruth& robot, TorqueCommand& command) const {
    command.computed = now;
    command.valid = robot.valid;
    command.torque = JointVector::Zero(3);
    if (robot.valid) command.torque = servo_.torque(to_seconds(now), robot.pose, robot.velocity);
  }

  Servo servo_;
};

}  // namespace flinch::test
