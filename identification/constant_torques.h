#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/dynamics_fit.h"

namespace flinch {

/// Errors of rows without the mean of each drive in each recording: where gravity, a payload or the zero of a
/// current is another, it is no error of the model [Nm or N].
Eigen::VectorXd without_constants(const DynamicsRows& rows, Eigen::VectorXd error);

/// What motions without contact need of each drive that no parameter explains, where it is more than what is
/// left, a sentence for each file. `unit`: of torques.
std::vector<std::string> notes_about_constants(const std::vector<std::string>& files, const DynamicsFit& fit,
                                               const std::string& unit);

}  // namespace flinch
