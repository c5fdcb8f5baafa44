#include "calibration/error_course.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/framework/random.h"

namespace flinch {
namespace {

/// Errors of so many drives that go as `course` says.
std::vector<std::vector<double>> rows_of(const ErrorCourse& course, std::size_t drives, std::size_t samples) {
  RandomGenerator random(4);
  std::vector<std::vector<double>> rows(drives);
  for (std::vector<double>& row : rows) {
    for (std::size_t t = 0; t < samples; ++t) {
      double z = course.innovation * random.normal();
      for (std::size_t j = 1; j <= std::min<std::size_t>(t, ErrorCourse::order); ++j)
        z += course.prediction[j - 1] * row[t - j];
      row.push_back(z);
    }
  }
  return rows;
}

TEST(ErrorCourse, IsFoundFromErrorsThatGoThatWay) {
  const ErrorCourse truth{.prediction = {1.1, -0.3, 0.2, -0.1}, .innovation = 0.4};
  constexpr std::size_t drives = 3, samples = 30'000;
  const ErrorCourse found = fit_error_course(rows_of(truth, drives, samples));
  const double deviation = 1.0 / std::sqrt(drives * samples);  // of each coefficient, at most
  for (std::size_t j = 0; j < truth.prediction.size(); ++j)
    EXPECT_NEAR(found.prediction[j], truth.prediction[j], 5.0 * deviation) << j;
  EXPECT_NEAR(found.innovation, truth.innovation, 5.0 * deviation * truth.innovation);
}

TEST(ErrorCourse, HasAnInnovationEvenWhereAllIsTold) {
  std::vector<std::vector<double>> rows(1);
  for (int t = 0; t < 1000; ++t) rows[0].push_back(std::sin(0.3 * t));
  EXPECT_EQ(fit_error_course(rows).innovation, 1e-3);
  rows[0].assign(1000, 0.0);
  EXPECT_EQ(fit_error_course(rows).innovation, 1e-3);
}

TEST(ErrorCourse, IsNotSoughtAcrossTheEndsOfRows) {
  const std::vector<std::vector<double>> rows = rows_of({.innovation = 0.5}, 2, 1000);
  std::vector<std::vector<double>> with_short = rows;
  for (const double value : {1e3, -1e3}) with_short.emplace_back(ErrorCourse::order, value);
  const ErrorCourse found = fit_error_course(rows), same = fit_error_course(with_short);
  EXPECT_EQ(found.prediction, same.prediction);
  EXPECT_EQ(found.innovation, same.innovation);
}

}  // namespace
}  // namespace flinch
