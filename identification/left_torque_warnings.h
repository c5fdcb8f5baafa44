#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/dynamics_rows.h"

namespace flinch {

/// Where something touched the robot, by what a fit of its dynamics leaves of the drives' torques: the mean
/// over half a second of a drive that moves is far beyond all others. `left`: of each row [Nm or N]; `files`:
/// of the recordings.
std::vector<std::string> warnings_about_contacts(const DynamicsRows& rows, const Eigen::VectorXd& left,
                                                 const std::vector<std::string>& files,
                                                 const std::string& unit);

/// Drives of which the torque that is left, or the friction in it, changes in the course of a recording, as
/// while a robot warms up.
std::vector<std::string> warnings_about_drift(const DynamicsRows& rows, const Eigen::VectorXd& left,
                                              const std::vector<std::string>& files, const std::string& unit);

}  // namespace flinch
