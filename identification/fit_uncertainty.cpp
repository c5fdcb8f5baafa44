#include "identification/fit_uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace flinch {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t fewest_clusters = 5;
constexpr double least_singular_value = 1e-7;  // of columns of length one

/// H^-1 where H may be singular.
MatrixXd pseudo_inverse(const MatrixXd& H) {
  VectorXd scale = H.diagonal().cwiseSqrt();
  for (double& s : scale) s = s > 0.0 ? 1.0 / s : 0.0;
  const MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
  const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  VectorXd inverse = svd.singularValues();
  for (double& s : inverse) s = s > 1e-13 * svd.singularValues()[0] ? 1.0 / s : 0.0;
  return scale.asDiagonal() * svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose() *
         scale.asDiagonal();
}

/// Two-sided 95 % quantile of Student's t over that of the normal distribution (Cornish and Fisher).
double student_factor(double freedom) {
  constexpr double z = 1.959964;
  const double z3 = z * z * z;
  const double first = (z3 + z) / (4.0 * freedom);
  const double second = (5.0 * z3 * z * z + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom);
  return (z + first + second) / z;
}

/// Sums over the rows of one group: H_g = A^T A, b_g = A^T r.
struct GroupSum {
  MatrixXd H;
  VectorXd b;
};

std::map<int, GroupSum> sums_by(const std::vector<int>& group, const LinearFit& fit) {
  std::map<int, GroupSum> sums;
  const Eigen::Index n = fit.jacobian.cols();
  for (Eigen::Index row = 0; row < fit.jacobian.rows(); ++row) {
    GroupSum& sum = sums[group[static_cast<std::size_t>(row)]];
    if (sum.H.size() == 0) sum = {MatrixXd::Zero(n, n), VectorXd::Zero(n)};
    const VectorXd a = fit.jacobian.row(row).transpose();
    sum.H += fit.weight[row] * a * a.transpose();
    sum.b += fit.weight[row] * fit.residual[row] * a;
  }
  return sums;
}

MatrixXd jackknife(const MatrixXd& H, const std::map<int, GroupSum>& clusters) {
  MatrixXd sum = MatrixXd::Zero(H.rows(), H.cols());
  for (const auto& [name, cluster] : clusters) {
    const VectorXd change = pseudo_inverse(H - cluster.H) * cluster.b;
    sum += change * change.transpose();
  }
  const double m = static_cast<double>(clusters.size());
  const double factor = student_factor(m - 1.0);
  return (m - 1.0) / m * factor * factor * sum;
}

MatrixXd from_scatter(const LinearFit& fit, const MatrixXd& inverse) {
  const double rows = fit.weight.sum();
  const double freedom = std::max(1.0, rows - static_cast<double>(fit.jacobian.cols()));
  return fit.residual.cwiseAbs2().dot(fit.weight) / freedom * inverse;
}

/// Rank and condition of the data; returns which parameters take part in a direction that they do not see.
std::vector<bool> find_rank(const LinearFit& fit, FitUncertainty& result) {
  MatrixXd A = fit.weight.cwiseSqrt().asDiagonal() * fit.jacobian;
  for (Eigen::Index i = 0; i < A.cols(); ++i) {
    const double length = A.col(i).norm();
    if (length > 0.0) A.col(i) /= length;
  }
  const Eigen::JacobiSVD<MatrixXd> svd(A.transpose() * A, Eigen::ComputeThinV);
  const VectorXd values = svd.singularValues().cwiseMax(0.0).cwiseSqrt();
  result.rank = static_cast<int>((values.array() > least_singular_value * values[0]).count());
  const bool full = result.rank == static_cast<int>(A.cols());
  result.condition = full ? values[0] / values[values.size() - 1] : std::numeric_limits<double>::infinity();
  std::vector<bool> unseen(static_cast<std::size_t>(A.cols()), false);
  for (Eigen::Index direction = result.rank; direction < A.cols(); ++direction) {
    for (Eigen::Index i = 0; i < A.cols(); ++i) {
      if (std::abs(svd.matrixV()(i, direction)) > 1e-3) unseen[static_cast<std::size_t>(i)] = true;
    }
  }
  return unseen;
}

}  // namespace

FitUncertainty fit_uncertainty(const LinearFit& fit) {
  const Eigen::Index n = fit.jacobian.cols();
  const std::map<int, GroupSum> clusters = sums_by(fit.cluster, fit);
  MatrixXd H = fit.prior_information.asDiagonal();
  for (const auto& [name, cluster] : clusters) H += cluster.H;
  const MatrixXd inverse = pseudo_inverse(H);

  FitUncertainty result;
  result.covariance = clusters.size() < fewest_clusters ? from_scatter(fit, inverse) : jackknife(H, clusters);
  result.covariance += inverse * fit.prior_information.asDiagonal() * inverse;
  result.deviation = result.covariance.diagonal().cwiseSqrt();
  const std::vector<bool> unseen = find_rank(fit, result);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool held = fit.prior_information[i] > 0.0;
    const bool seen = held || !unseen[static_cast<std::size_t>(i)];
    const double believed =
        held ? 1.0 / std::sqrt(fit.prior_information[i]) : std::numeric_limits<double>::infinity();
    const bool tells = result.deviation[i] < 0.5 * believed && result.deviation[i] > 0.0;
    result.identifiable.push_back(seen && tells);
  }
  const std::map<int, GroupSum> recordings = sums_by(fit.recording, fit);
  result.influence = MatrixXd::Zero(n, static_cast<Eigen::Index>(recordings.size()));
  if (recordings.size() < 2) return result;
  Eigen::Index column = 0;
  for (const auto& [name, recording] : recordings) {
    result.influence.col(column++) = pseudo_inverse(H - recording.H) * recording.b;
  }
  return result;
}

}  // namespace flinch
