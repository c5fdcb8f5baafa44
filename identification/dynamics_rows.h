#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/dynamic_parameters.h"

namespace flinch {

struct Recording;

/// Where the drives stood at every sample of a stretch, one column a drive.
struct DrivePath {
  Eigen::MatrixXd position;  ///< [rad or m]
  double period = 0.0;       ///< [s]

  /// Of a drive at a sample, signed [rad/s or m/s].
  double speed(Eigen::Index sample, int drive) const;
  /// The way within which a drive that is as fast as at this sample is no longer resolved [rad or m].
  double blur(Eigen::Index sample, int drive) const;
};

/// What a recorded motion says of the dynamics: for samples and drives the measured torque without what is
/// believed to cause it, and how it depends on each parameter; both low-passed in the same way and thinned
/// out.
struct DynamicsRows {
  Eigen::MatrixXd regressor;  ///< Y: d tau / d parameter, one row for each sample and drive
  Eigen::VectorXd surplus;    ///< tau - tau_believed [Nm or N]
  Eigen::VectorXd torque;     ///< tau [Nm or N]
  Eigen::VectorXd slope;      ///< d tau / dt [Nm/s or N/s]
  std::vector<int> drive;
  std::vector<int> cluster;
  std::vector<int> recording;
  std::vector<double> time;  ///< [s]
  std::vector<DrivePath> paths;
  std::vector<std::size_t> path;     ///< of each row
  std::vector<Eigen::Index> sample;  ///< of that
  double noise = 0.0;                ///< of the torque, from the noise of the current [Nm or N]

  void append(const DynamicsRows& more);
};

/// What makes torques of currents.
struct TorqueBelief {
  JointVector constant;  ///< [Nm/A or N/A]
  JointVector delay{};   ///< by which torques are behind their currents [s]; empty: not at all
  /// For how long each current acts; zero: until the next reading. A log may have fewer readings than that.
  Time held{};
};

/// The rows of one recording. `warnings`: what is wrong with parts of it. Throws SetupError where nothing can
/// be done with it.
DynamicsRows dynamics_rows(const Recording& recording, const ParallelRobot& robot,
                           const DynamicParameters& parameters, const TorqueBelief& belief, int number,
                           std::vector<std::string>& warnings);

/// The numbers of one drive out of those of all.
Eigen::VectorXd of_drive(const DynamicsRows& rows, const Eigen::VectorXd& numbers, int drive);

/// Of each row of a drive what `of` says of its position, low-passed as the rows are. Rows of
/// other drives are zero.
Eigen::MatrixXd along_the_way(const DynamicsRows& rows, int drive,
                              const std::function<Eigen::RowVector3d(double position)>& of);

}  // namespace flinch
