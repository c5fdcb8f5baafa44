#pragma once

#include <Eigen/Core>
#include <vector>

namespace flinch {

/// A least-squares fit at its solution, linearised: rows are residuals, already divided by their standard
/// deviations, columns are parameters.
struct LinearFit {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
  Eigen::VectorXd weight;             ///< Of each row, 0 to 1: what the robust loss leaves of it, rho'.
  Eigen::VectorXd bend;               ///< 2 rho'': the loss is rho of the squared length of a block of rows.
  std::vector<int> block;             ///< To which each row belongs, in ascending order.
  std::vector<int> cluster;           ///< Rows of one cluster have errors in common.
  std::vector<int> recording;         ///< From which each row comes.
  Eigen::VectorXd prior_information;  ///< 1 / sigma^2 by which each is drawn to what is believed; 0: not.
  /// Sigma of what is believed of each parameter, where some are drawn to it more closely than it is sure;
  /// empty: none is.
  Eigen::VectorXd believed_deviation;
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

/// A robust loss leaves residuals less weight the larger they are, so another sample would move the solution
/// further than the weights at this one let it: what resists a move is the curvature of the loss,
/// sum of A^T (rho' 1 + 2 rho'' r r^T) A over all blocks (Huber, Robust Statistics, 6.3), not sum of
/// rho' A^T A.
///
/// Errors of neighbouring rows are not independent: cogging, friction and the instrument's mounting are the
/// same for many. So the covariance comes from leaving out one cluster after the other (the jackknife, CR3 of
/// MacKinnon and White 1985), widened as Student's t for as few clusters; with fewer than five clusters as if
/// each block were one. What is only believed adds its own uncertainty, also to the others where it is held:
/// nobody knows a parameter better for not having looked for it.
FitUncertainty fit_uncertainty(const LinearFit& fit);

}  // namespace flinch
