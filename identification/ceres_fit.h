#pragma once

// What the fits share of Ceres. It includes its headers, so only sources of this folder include it.
#include <ceres/ceres.h>

#include <vector>

#include "identification/fit_uncertainty.h"

namespace flinch {

/// What a residual of many standard deviations counts. Huber: as 1.5, linearly. Tukey: from 4.685 on nothing.
enum class Loss { none, huber, tukey };

/// Null for none. Ceres owns it.
ceres::LossFunction* loss_function(Loss loss);

/// Adds (x - mean) / deviation for each entry of the block `values`.
void add_belief(ceres::Problem& problem, double* values, const Eigen::VectorXd& mean,
                const Eigen::VectorXd& deviation);

/// Solves in one thread, until the cost changes by no more than a share `tolerance`: to the last digit where
/// nothing else is said. Throws SetupError where there is no solution.
void solve_problem(ceres::Problem& problem, double tolerance = 1e-14);

/// The rows of `blocks` at the solution; the columns of `columns`, in their order and in the tangent spaces
/// of their manifolds.
LinearFit linearised(ceres::Problem& problem, const std::vector<ceres::ResidualBlockId>& blocks,
                     const std::vector<double*>& columns, Loss loss);

}  // namespace flinch
