#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/dynamics_rows.h"
#include "identification/fit_uncertainty.h"
#include "systems/robot/dynamic_parameters.h"

namespace flinch {

/// Dynamic parameters and an offset of each drive that explain a motion best.
struct DynamicsFit {
  Eigen::VectorXd values;     ///< of the parameters, in the order of their list
  Eigen::VectorXd offset;     ///< of each drive [Nm or N]
  Eigen::VectorXd deviation;  ///< of what is left, of each drive, outliers apart [Nm or N]
  /// Columns: the parameters, then the offsets.
  LinearFit linear;
};

/// Minimises the squares of (Y (p - p_believed) + o - surplus) / sigma over all rows, and of
/// (p - p_believed) / sigma_believed, where no parameter is below its least value and those that are `held`
/// stay as believed. `usual_error`: of a row before anything is known. Loss: Huber, then Tukey; sigma of each
/// drive from what is left. Ceres.
DynamicsFit fit_dynamics(const DynamicsRows& rows, const std::vector<DynamicParameter>& parameters,
                         int drives, double usual_error, const std::vector<bool>& held);

}  // namespace flinch
