#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "systems/robot/parallel_robot.h"

namespace flinch {

struct Recording;

/// A reading of the gyroscope as it came.
struct GyroscopeSample {
  double acquired = 0.0;  ///< By the stamp of the sensor [s].
  Eigen::Vector3d rate;   ///< In the sensor's axes [rad/s].
};

/// What an IMU on the platform said over one stretch of a recording, beside what the encoders say of the
/// platform, both low-passed in the same way and without delay. One row a period.
struct ImuStretch {
  static constexpr double edge = 0.05;  ///< Of both ends, where filters lack past or future [s].

  int recording = 0;
  double start = 0.0;                  ///< of the first row [s]
  double period = 0.0;                 ///< [s]
  Eigen::MatrixXd gyroscope;           ///< by the tick at which it arrived, in the sensor's axes [rad/s]
  Eigen::MatrixXd accelerometer;       ///< likewise [m/s^2]
  std::vector<char> usable;            ///< of each row: the reading is there and within its range
  std::vector<GyroscopeSample> rates;  ///< of the usable readings, not filtered
  double stamped_age = 0.0;            ///< by how much the sensor's own stamps are older than its arrival [s]

  // Of the platform, in its own axes.
  Eigen::MatrixXd angular_velocity;      ///< [rad/s]
  Eigen::MatrixXd angular_acceleration;  ///< [rad/s^2]
  Eigen::MatrixXd specific_force;        ///< R^T (a - gravity), at its origin [m/s^2]
};

/// The stretches of a recording. `warnings`: what is wrong with parts of it. Throws SetupError where nothing
/// can be done with it.
std::vector<ImuStretch> imu_stretches(const Recording& recording, const ParallelRobot& robot, int number,
                                      std::vector<std::string>& warnings);

}  // namespace flinch
