#include "identification/ceres_fit.h"

#include <ceres/normal_prior.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double huber_limit = 1.5;
constexpr double tukey_limit = 4.685;

}  // namespace

ceres::LossFunction* loss_function(Loss loss) {
  if (loss == Loss::huber) return new ceres::HuberLoss(huber_limit);
  if (loss == Loss::tukey) return new ceres::TukeyLoss(tukey_limit);
  return nullptr;
}

void add_belief(ceres::Problem& problem, double* values, const Eigen::VectorXd& mean,
                const Eigen::VectorXd& deviation) {
  const Eigen::MatrixXd root = deviation.cwiseInverse().asDiagonal();
  problem.AddResidualBlock(new ceres::NormalPrior(root, mean), nullptr, values);
}

void solve_problem(ceres::Problem& problem, double tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = tolerance;
  options.parameter_tolerance = 100.0 * tolerance;
  options.gradient_tolerance = tolerance;
  options.num_threads = 1;  // the same bits every time
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) throw SetupError("the fit has no solution: " + summary.message);
}

LinearFit linearised(ceres::Problem& problem, const std::vector<ceres::ResidualBlockId>& blocks,
                     const std::vector<double*>& columns, Loss loss) {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = blocks;
  options.parameter_blocks = columns;
  options.apply_loss_function = false;
  options.num_threads = 1;
  std::vector<double> residuals;
  ceres::CRSMatrix sparse;
  problem.Evaluate(options, nullptr, &residuals, nullptr, &sparse);

  LinearFit fit;
  fit.residual =
      Eigen::Map<const Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
  fit.jacobian.setZero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    const auto begin = static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(row)]);
    const auto end = static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(row) + 1]);
    for (std::size_t i = begin; i < end; ++i) fit.jacobian(row, sparse.cols[i]) = sparse.values[i];
  }
  fit.weight.setOnes(fit.residual.size());
  fit.bend.setZero(fit.residual.size());
  fit.block.resize(residuals.size());
  const std::unique_ptr<ceres::LossFunction> function(loss_function(loss));
  Eigen::Index row = 0;
  for (const ceres::ResidualBlockId block : blocks) {
    const int size = problem.GetCostFunctionForResidualBlock(block)->num_residuals();
    double rho[3] = {0.0, 1.0, 0.0};
    const double squared = fit.residual.segment(row, size).squaredNorm();
    if (function) function->Evaluate(squared, rho);
    fit.weight.segment(row, size).setConstant(rho[1]);
    fit.bend.segment(row, size).setConstant(2.0 * rho[2]);
    std::fill_n(fit.block.begin() + row, size, static_cast<int>(row));
    row += size;
  }
  return fit;
}

}  // namespace flinch
