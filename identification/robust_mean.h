#pragma once

#include <Eigen/Core>
#include <vector>

namespace flinch {

/// The mean of what is not far off.
struct RobustMean {
  double value = 0.0;
  double deviation = 0.0;  ///< Standard deviation of the mean, where samples are independent.
};

/// The mean of all samples within four standard deviations of their median, which are told by the median
/// distance from it; not a number where there are none.
RobustMean robust_mean(const Eigen::VectorXd& samples);

/// Standard deviation of normal values whose median distance from zero is that of `residuals`.
double robust_deviation(const std::vector<double>& residuals);

}  // namespace flinch
