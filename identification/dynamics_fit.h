#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/dynamics_rows.h"
#include "identification/fit_uncertainty.h"
#include "systems/robot/dynamic_parameters.h"

namespace flinch {

/// Dynamic parameters that explain motions best, with a constant torque of each drive in each recording: the
/// direction of gravity, a payload or the zero of a current may be others there.
struct DynamicsFit {
  Eigen::VectorXd values;     ///< of the parameters, in the order of their list
  Eigen::VectorXd offset;     ///< of all drives of the first recording, then of the next [Nm or N]
  Eigen::VectorXd deviation;  ///< of what is left, of each drive, outliers apart [Nm or N]
  /// Columns: the parameters, then the offsets.
  LinearFit linear;

  /// Of a row.
  double offset_of(const DynamicsRows& rows, Eigen::Index row) const {
    return offset[place_of_offset(rows, row, static_cast<int>(deviation.size()))];
  }
  static Eigen::Index place_of_offset(const DynamicsRows& rows, Eigen::Index row, int drives) {
    const auto at = static_cast<std::size_t>(row);
    return static_cast<Eigen::Index>(rows.recording[at]) * drives + rows.drive[at];
  }
};

/// Minimises the squares of (Y (p - p_believed) + o - surplus) / sigma over all rows, and of
/// (p - p_believed) / sigma_believed, where no parameter is below its least value and those that are `held`
/// stay as believed. `usual_error`: of a row before anything is known. Loss: Huber, then Tukey; sigma of each
/// drive from what is left. Ceres.
DynamicsFit fit_dynamics(const DynamicsRows& rows, const std::vector<DynamicParameter>& parameters,
                         int drives, double usual_error, const std::vector<bool>& held);

}  // namespace flinch
