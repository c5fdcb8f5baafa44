#include "identification/fit_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t fewest_clusters = 5;
constexpr double little_news = 0.9;            // of the belief: what deviation the data leave
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

/// Sums over the blocks of one group: H = A^T (rho' 1 + 2 rho'' r r^T) A, b = rho' A^T r.
struct GroupSum {
  MatrixXd H;
  VectorXd b;
};

/// Calls act(first row, rows) for each block.
template <class Act>
void for_each_block(const LinearFit& fit, const Act& act) {
  const auto rows = fit.jacobian.rows();
  const auto block = [&](Eigen::Index row) { return fit.block[static_cast<std::size_t>(row)]; };
  for (Eigen::Index first = 0, end = 0; first < rows; first = end) {
    while (end < rows && block(end) == block(first)) ++end;
    act(first, end - first);
  }
}

std::map<int, GroupSum> sums_by(const std::vector<int>& group, const LinearFit& fit) {
  std::map<int, GroupSum> sums;
  const Eigen::Index n = fit.jacobian.cols();
  for_each_block(fit, [&](Eigen::Index first, Eigen::Index rows) {
    GroupSum& sum = sums[group[static_cast<std::size_t>(first)]];
    if (sum.H.size() == 0) sum = {MatrixXd::Zero(n, n), VectorXd::Zero(n)};
    const auto A = fit.jacobian.middleRows(first, rows);
    const VectorXd gradient = A.transpose() * fit.residual.segment(first, rows);
    sum.H += fit.weight[first] * A.transpose() * A + fit.bend[first] * gradient * gradient.transpose();
    sum.b += fit.weight[first] * gradient;
  });
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

/// As if each block were a cluster.
MatrixXd from_scatter(const LinearFit& fit, const MatrixXd& inverse) {
  MatrixXd sum = MatrixXd::Zero(inverse.rows(), inverse.cols());
  for_each_block(fit, [&](Eigen::Index first, Eigen::Index rows) {
    const VectorXd b = fit.weight[first] * fit.jacobian.middleRows(first, rows).transpose() *
                       fit.residual.segment(first, rows);
    sum += b * b.transpose();
  });
  const double all = fit.weight.sum();
  const double freedom = std::max(1.0, all - static_cast<double>(fit.jacobian.cols()));
  return all / freedom * inverse * sum * inverse;
}

/// Variance of P (x - x_believed), by which the belief draws at each parameter: P sigma^2 P, which is P where
/// it draws as much as it is sure.
VectorXd from_belief(const LinearFit& fit) {
  const VectorXd& P = fit.prior_information;
  if (fit.believed_deviation.size() == 0) return P;
  return (P.cwiseProduct(fit.believed_deviation)).cwiseAbs2();
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
  result.covariance += inverse * from_belief(fit).asDiagonal() * inverse;
  result.deviation = result.covariance.diagonal().cwiseSqrt();
  const std::vector<bool> unseen = find_rank(fit, result);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool held = fit.prior_information[i] > 0.0;
    const bool seen = held || !unseen[static_cast<std::size_t>(i)];
    const double believed =
        held ? 1.0 / std::sqrt(fit.prior_information[i]) : std::numeric_limits<double>::infinity();
    const bool tells = result.deviation[i] < little_news * believed && result.deviation[i] > 0.0;
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
