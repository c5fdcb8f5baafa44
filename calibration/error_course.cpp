#include "calibration/error_course.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double least_innovation = 1e-3;  // of the deviation of errors

}  // namespace

/// Least squares: sum of b b^T a = sum of b z, b those before z.
ErrorCourse fit_error_course(std::span<const std::vector<double>> rows) {
  constexpr int order = ErrorCourse::order;
  using Before = Eigen::Matrix<double, order, 1>;
  Eigen::Matrix<double, order, order> squares = Eigen::Matrix<double, order, order>::Zero();
  Before products = Before::Zero();
  double square = 0.0, count = 0.0;
  for (const std::vector<double>& row : rows) {
    for (std::size_t t = order; t < row.size(); ++t) {
      const Before before = Eigen::Map<const Before>(&row[t - order]).reverse();
      squares += before * before.transpose();
      products += row[t] * before;
      square += row[t] * row[t];
      count += 1.0;
    }
  }
  const Before prediction = squares.ldlt().solve(products);
  ErrorCourse course;
  Before::Map(course.prediction.data()) = prediction;
  course.innovation = std::max(least_innovation, std::sqrt((square - prediction.dot(products)) / count));
  return course;
}

}  // namespace flinch
