#include "calibration/autoregressive_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "systems/framework/random.h"

namespace flinch {
namespace {

/// Errors of so many drives that go as `course` says, one sample after the other.
std::vector<JointVector> errors_of(const AutoregressiveError& course, int drives, std::size_t samples) {
  RandomGenerator random(4);
  std::vector<JointVector> errors;
  for (std::size_t t = 0; t < samples; ++t) {
    JointVector z = JointVector::Zero(drives);
    for (std::size_t j = 1; j <= std::min<std::size_t>(t, AutoregressiveError::order); ++j)
      z += course.prediction[j - 1] * errors[t - j];
    for (double& each : z) each += course.innovation * random.normal();
    errors.push_back(z);
  }
  return errors;
}

void add(const std::vector<JointVector>& errors, AutoregressiveErrorFit& fit) {
  for (const JointVector& each : errors) fit.add(each);
}

AutoregressiveError course_of(const std::vector<JointVector>& errors) {
  AutoregressiveErrorFit fit;
  add(errors, fit);
  return fit.course().value();
}

TEST(AutoregressiveError, IsFoundFromErrorsThatGoThatWay) {
  const AutoregressiveError truth{.prediction = {1.1, -0.3, 0.2, -0.1}, .innovation = 0.4};
  constexpr int drives = 3, samples = 30'000;
  const AutoregressiveError found = course_of(errors_of(truth, drives, samples));
  const double deviation = 1.0 / std::sqrt(drives * samples);  // of each coefficient, at most
  for (std::size_t j = 0; j < truth.prediction.size(); ++j)
    EXPECT_NEAR(found.prediction[j], truth.prediction[j], 5.0 * deviation) << j;
  EXPECT_NEAR(found.innovation, truth.innovation, 5.0 * deviation * truth.innovation);
}

TEST(AutoregressiveError, HasAnInnovationEvenWhereAllIsTold) {
  std::vector<JointVector> errors;
  for (int t = 0; t < 1000; ++t) errors.push_back(JointVector::Constant(1, std::sin(0.3 * t)));
  EXPECT_EQ(course_of(errors).innovation, 1e-3);
  EXPECT_EQ(course_of(std::vector<JointVector>(1000, JointVector::Zero(1))).innovation, 1e-3);
}

TEST(AutoregressiveError, IsNotSoughtAcrossGaps) {
  const std::vector<JointVector> errors = errors_of({.innovation = 0.5}, 2, 1000);
  AutoregressiveErrorFit fit;
  add(errors, fit);
  for (const double value : {1e3, -1e3}) {
    fit.interrupt();
    add(std::vector<JointVector>(AutoregressiveError::order, JointVector::Constant(2, value)), fit);
  }
  const AutoregressiveError found = fit.course().value(), same = course_of(errors);
  EXPECT_EQ(found.prediction, same.prediction);
  EXPECT_EQ(found.innovation, same.innovation);
}

TEST(AutoregressiveError, IsNotKnownOfSamplesWithGapsBetweenAll) {
  AutoregressiveErrorFit fit;
  for (int t = 0; t < 1000; ++t) {
    fit.interrupt();
    fit.add(JointVector::Constant(2, 0.1 * t));
  }
  EXPECT_FALSE(fit.course());
}

TEST(AutoregressiveError, GoesOnBehindAGapAsBeforeIt) {
  const std::vector<JointVector> errors = errors_of({.prediction = {0.8}, .innovation = 0.5}, 2, 1000);
  AutoregressiveErrorFit once, twice;
  add(errors, once);
  for (int times = 0; times < 2; ++times) {
    twice.interrupt();
    add(errors, twice);
  }
  const AutoregressiveError found = twice.course().value(), same = once.course().value();
  for (std::size_t j = 0; j < AutoregressiveError::order; ++j)
    EXPECT_NEAR(found.prediction[j], same.prediction[j], 1e-12) << j;
  EXPECT_NEAR(found.innovation, same.innovation, 1e-12);
}

}  // namespace
}  // namespace flinch
