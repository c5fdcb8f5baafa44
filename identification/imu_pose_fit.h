#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "identification/fit_uncertainty.h"
#include "identification/imu_samples.h"
#include "systems/robot/imu_mount.h"

namespace flinch {

/// What is believed of an IMU before anything is measured; deviations.
struct ImuBelief {
  ImuMount mount;
  double position_deviation = 0.05;            ///< [m]
  double gyroscope_bias_deviation = 0.052;     ///< 3 degrees/s, [RAL25] IV-A [rad/s]
  double accelerometer_bias_deviation = 0.39;  ///< 0.04 g, [RAL25] IV-A [m/s^2]
  double largest_delay = 0.01;                 ///< [s]
};

/// Where an IMU sits, how it is turned, by what its readings are off and how late they arrive.
struct ImuPose {
  Eigen::Quaterniond R_ES = Eigen::Quaterniond::Identity();  ///< from the sensor's axes to the platform's
  Eigen::Vector3d position{0.0, 0.0, 0.0};                   ///< p_S, in the platform's frame [m]
  Eigen::Vector3d gyroscope_bias{0.0, 0.0, 0.0};             ///< [rad/s]
  Eigen::Vector3d accelerometer_bias{0.0, 0.0, 0.0};         ///< [m/s^2]
  double delay = 0.0;  ///< from the motion to the tick at which its reading is there [s]
};

struct ImuPoseFit {
  ImuPose pose;
  double cost = 0.0;
  double gyroscope_deviation = 0.0;      ///< of what is left [rad/s]
  double accelerometer_deviation = 0.0;  ///< [m/s^2]
  /// Columns: rotation vector in the platform's axes, position, biases of gyroscope and accelerometer, delay.
  LinearFit linear;
};

/// Minimises [RAL25] (10) with biases and delay: over all samples i the squares of
///   ( w_i - R_SE w(t_i - tau) - b_g ) / sigma_w
///   ( a_i - R_SE (f + dw x p + w x (w x p))(t_i - tau) - b_a ) / sigma_a
/// from eight starts about the z axis. Ceres; references are cubic splines.
ImuPoseFit fit_imu_pose(const std::vector<ImuStretch>& stretches, const ImuBelief& belief);

/// What is left of gyroscope and accelerometer at a pose, rows that are fitted; outliers among them.
struct ImuResiduals {
  Eigen::MatrixXd gyroscope;      ///< [rad/s]
  Eigen::MatrixXd accelerometer;  ///< [m/s^2]
  Eigen::MatrixXd measured_gyroscope;
  Eigen::MatrixXd measured_accelerometer;
  std::vector<double> time;  ///< [s]
};
ImuResiduals imu_residuals(const std::vector<ImuStretch>& stretches, const ImuPose& pose);

/// The same rotation turned by a small rotation vector in the platform's axes, as the columns of the fit
/// count.
Eigen::Quaterniond turned(const Eigen::Quaterniond& R_ES, const Eigen::Vector3d& by);

/// Turns about x, then y, then z of the turned frames: those of ImuMount [rad].
Eigen::Vector3d mount_angles(const Eigen::Quaterniond& R_ES);

}  // namespace flinch
