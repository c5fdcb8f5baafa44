#include "calibration/autoregressive_error.h"

#include <algorithm>
#include <cmath>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double least_innovation = 1e-3;  // of the deviation of errors

}  // namespace

void AutoregressiveErrorFit::add(const JointVector& errors) {
  if (samples_ == order) {
    for (int i = 0; i < errors.size(); ++i) {
      Eigen::Matrix<double, order, 1> before;
      for (int j = 0; j < order; ++j) before[j] = before_[static_cast<std::size_t>(j)][i];
      squares_ += before * before.transpose();
      products_ += errors[i] * before;
      square_ += errors[i] * errors[i];
      count_ += 1.0;
    }
  }
  samples_ = std::min(samples_ + 1, order);
  std::copy_backward(before_.begin(), before_.end() - 1, before_.end());
  before_.front() = errors;
}

/// Least squares: sum of b b^T a = sum of b z.
std::optional<AutoregressiveError> AutoregressiveErrorFit::course() const {
  if (count_ == 0.0) return std::nullopt;
  const Eigen::Matrix<double, order, 1> prediction = squares_.ldlt().solve(products_);
  AutoregressiveError course;
  Eigen::Matrix<double, order, 1>::Map(course.prediction.data()) = prediction;
  course.innovation = std::max(least_innovation, std::sqrt((square_ - prediction.dot(products_)) / count_));
  return course;
}

}  // namespace flinch
