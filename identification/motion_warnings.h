#pragma once

#include <string>
#include <vector>

#include "identification/dynamics_rows.h"

namespace flinch {

/// Why currents and motion cannot be what they are said to be, each with its likely cause: a current with the
/// other sign or in another unit, beside the torque that the robot as it is believed needs for its motion.
std::vector<std::string> warnings_about_motion(const DynamicsRows& rows, int drives);

/// Of values that lie further from what was believed than by five of its deviations, the worst three.
std::vector<std::string> warnings_about_values(const DynamicParameters& parameters,
                                               const Eigen::VectorXd& values, const std::vector<bool>& held);

}  // namespace flinch
