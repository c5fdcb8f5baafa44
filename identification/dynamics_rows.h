#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/dynamic_parameters.h"

namespace flinch {

struct Recording;

/// What a recorded motion says of the dynamics: for samples and drives the measured torque without what is
/// believed to cause it, and how it depends on each parameter; both low-passed in the same way and thinned
/// out.
struct DynamicsRows {
  Eigen::MatrixXd regressor;  ///< Y: d tau / d parameter, one row for each sample and drive
  Eigen::VectorXd surplus;    ///< tau - tau_believed [Nm or N]
  Eigen::VectorXd torque;     ///< tau [Nm or N]
  std::vector<int> drive;
  std::vector<int> cluster;
  std::vector<int> recording;
  std::vector<double> time;  ///< [s]
  double noise = 0.0;        ///< of the torque, from the noise of the current [Nm or N]

  void append(const DynamicsRows& more);
};

/// The rows of one recording. `constant`: torque constants. `warnings`: what is wrong with parts of it.
/// Throws SetupError where nothing can be done with it.
DynamicsRows dynamics_rows(const Recording& recording, const ParallelRobot& robot,
                           const DynamicParameters& parameters, const JointVector& constant, int number,
                           std::vector<std::string>& warnings);

}  // namespace flinch
