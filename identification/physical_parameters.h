#pragma once

#include <Eigen/Core>

#include "systems/robot/dynamic_parameters.h"

namespace flinch {

/// Whether a robot can have these values: masses, moments and friction not below their least, and all
/// `must_be_definite` of them positive definite.
bool is_physical(const DynamicParameters& parameters, const Eigen::VectorXd& values);

/// Of all values that a robot can have those with the least (p - values)^T H (p - values), where H is the
/// `information` that a fit has of them. The problem is convex; solved by Newton's method with a logarithmic
/// barrier (Boyd and Vandenberghe, Convex Optimization, 11.3), which begins at what is believed. Throws
/// SetupError where that is not physical itself.
Eigen::VectorXd nearest_physical(const DynamicParameters& parameters, const Eigen::VectorXd& values,
                                 const Eigen::MatrixXd& information);

}  // namespace flinch
