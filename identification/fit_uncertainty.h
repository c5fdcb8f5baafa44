#pragma once

#include <Eigen/Core>
#include <vector>

namespace flinch {

/// A least-squares fit at its solution, linearised: rows are residuals, already divided by their standard
/// deviations, columns are parameters.
struct LinearFit {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  Eigen::VectorXd weight;             ///< Of each row, 0 to 1: what the robust loss leaves of it.
  std::vector<int> cluster;           ///< Rows of one cluster have errors in common.
  std::vector<int> recording;         ///< From which each row comes.
  Eigen::VectorXd prior_information;  ///< 1 / sigma^2 of what was believed of each parameter; 0: nothing.
};

/// How sure a fit is of its parameters.
struct FitUncertainty {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd deviation;       ///< Its diagonal's root.
  std::vector<bool> identifiable;  ///< Whether the data say something of it that was not believed before.
  int rank = 0;                    ///< Of the data alone, columns scaled to length one.
  double condition = 0.0;          ///< Likewise; infinite where the rank is not full.
  Eigen::MatrixXd influence;       ///< Column g: how parameters change where recording g is left out.
};

/// Errors of neighbouring rows are not independent: cogging, friction and the instrument's mounting are the
/// same for many. So the covariance comes from leaving out one cluster after the other (the jackknife, CR3 of
/// MacKinnon and White 1985), widened as Student's t for as few clusters; with fewer than five clusters from
/// the scatter of the residuals. What is only believed adds its own uncertainty.
FitUncertainty fit_uncertainty(const LinearFit& fit);

}  // namespace flinch
