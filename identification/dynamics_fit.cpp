#include "identification/dynamics_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <memory>

#include "identification/ceres_fit.h"
#include "identification/robust_mean.h"

namespace flinch {
namespace {

constexpr double on_the_way = 1e-7, in_the_end = 1e-14;  // relative changes that count as none

/// One row: scaled parameters x = (p - p_believed) / sigma_believed, then the offset of the row.
class RowResidual final : public ceres::CostFunction {
 public:
  RowResidual(Eigen::RowVectorXd slopes, double surplus, double sigma)
      : slopes_(std::move(slopes)), surplus_(surplus), sigma_(sigma) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(slopes_.size()));
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> x(blocks[0], slopes_.size());
    residuals[0] = (slopes_.dot(x) + blocks[1][0] - surplus_) / sigma_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
      Eigen::Map<Eigen::RowVectorXd>(jacobians[0], slopes_.size()) = slopes_ / sigma_;
    if (jacobians[1] != nullptr) jacobians[1][0] = 1.0 / sigma_;
    return true;
  }

 private:
  Eigen::RowVectorXd slopes_;
  double surplus_, sigma_;
};

class Fit {
 public:
  Fit(const DynamicsRows& rows, const std::vector<DynamicParameter>& parameters, int drives,
      double usual_error, const std::vector<bool>& held)
      : rows_(rows), parameters_(parameters), held_(held), usual_error_(usual_error) {
    const auto p = static_cast<Eigen::Index>(parameters.size());
    x_.setZero(p);
    const int recordings = 1 + *std::max_element(rows.recording.begin(), rows.recording.end());
    offset_.setZero(static_cast<Eigen::Index>(recordings) * drives);
    sigma_.setConstant(drives, usual_error);
    scale_.resize(p);
    for (Eigen::Index j = 0; j < p; ++j) scale_[j] = of(j).deviation;
  }

  void solve(Loss loss, double tolerance) {
    problem_ = std::make_unique<ceres::Problem>();
    blocks_.clear();
    for (Eigen::Index row = 0; row < rows_.surplus.size(); ++row) {
      const int drive = rows_.drive[static_cast<std::size_t>(row)];
      const Eigen::RowVectorXd slopes = rows_.regressor.row(row).cwiseProduct(scale_.transpose());
      blocks_.push_back(problem_->AddResidualBlock(new RowResidual(slopes, rows_.surplus[row], sigma_[drive]),
                                                   loss_function(loss), x_.data(), &offset_[offset_at(row)]));
    }
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      problem_->SetParameterLowerBound(x_.data(), static_cast<int>(j),
                                       (of(j).least - of(j).believed) / scale_[j]);
    }
    add_belief(*problem_, x_.data(), Eigen::VectorXd::Zero(x_.size()), belief());
    for (double& offset : offset_) {
      add_belief(*problem_, &offset, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, usual_error_));
    }
    solve_problem(*problem_, tolerance);
  }

  void rescale() {
    std::vector<std::vector<double>> left(static_cast<std::size_t>(sigma_.size()));
    const Eigen::VectorXd step = x_.cwiseProduct(scale_);
    for (Eigen::Index row = 0; row < rows_.surplus.size(); ++row) {
      const int drive = rows_.drive[static_cast<std::size_t>(row)];
      left[static_cast<std::size_t>(drive)].push_back(rows_.regressor.row(row).dot(step) +
                                                      offset_[offset_at(row)] - rows_.surplus[row]);
    }
    for (Eigen::Index i = 0; i < sigma_.size(); ++i)
      sigma_[i] = robust_deviation(left[static_cast<std::size_t>(i)]) + 1e-9 * usual_error_;
  }

  DynamicsFit take(Loss loss) {
    DynamicsFit fit;
    fit.values.resize(x_.size());
    for (Eigen::Index j = 0; j < x_.size(); ++j) fit.values[j] = of(j).believed + x_[j] * scale_[j];
    fit.offset = offset_;
    fit.deviation = sigma_;
    std::vector<double*> columns = {x_.data()};
    for (double& offset : offset_) columns.push_back(&offset);
    fit.linear = linearised(*problem_, blocks_, columns, loss);
    for (Eigen::Index j = 0; j < x_.size(); ++j) fit.linear.jacobian.col(j) /= scale_[j];
    fit.linear.cluster = rows_.cluster;
    fit.linear.recording = rows_.recording;
    fit.linear.prior_information.resize(x_.size() + offset_.size());
    fit.linear.prior_information << belief().cwiseProduct(scale_).cwiseAbs2().cwiseInverse(),
        Eigen::VectorXd::Constant(offset_.size(), 1.0 / (usual_error_ * usual_error_));
    fit.linear.believed_deviation.setConstant(x_.size() + offset_.size(), usual_error_);
    fit.linear.believed_deviation.head(x_.size()) = scale_;
    return fit;
  }

 private:
  static constexpr double hold = 1e-3;  // of the belief

  Eigen::Index offset_at(Eigen::Index row) const {
    return DynamicsFit::place_of_offset(rows_, row, static_cast<int>(sigma_.size()));
  }
  const DynamicParameter& of(Eigen::Index j) const { return parameters_[static_cast<std::size_t>(j)]; }
  Eigen::VectorXd belief() const {
    Eigen::VectorXd deviation = Eigen::VectorXd::Ones(x_.size());
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      if (held_[static_cast<std::size_t>(j)]) deviation[j] = hold;
    }
    return deviation;
  }

  const DynamicsRows& rows_;
  const std::vector<DynamicParameter>& parameters_;
  const std::vector<bool>& held_;
  double usual_error_;
  Eigen::VectorXd x_, offset_, sigma_, scale_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<ceres::ResidualBlockId> blocks_;
};

}  // namespace

DynamicsFit fit_dynamics(const DynamicsRows& rows, const std::vector<DynamicParameter>& parameters,
                         int drives, double usual_error, const std::vector<bool>& held) {
  Fit fit(rows, parameters, drives, usual_error, held);
  for (const Loss loss : {Loss::huber, Loss::huber, Loss::tukey, Loss::tukey}) {
    fit.solve(loss, on_the_way);
    fit.rescale();
  }
  fit.solve(Loss::tukey, in_the_end);
  return fit.take(Loss::tukey);
}

}  // namespace flinch
