#include "identification/fit_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "systems/framework/random.h"

namespace flinch {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A linear model y = A x with clusters of rows that have an error in common, at its solution.
struct Trial {
  MatrixXd A;
  VectorXd y;
  LinearFit fit;
  VectorXd x;

  explicit Trial(std::uint64_t seed, int clusters = 20, int rows = 15) {
    RandomGenerator random(seed);
    A.resize(clusters * rows, 3);
    y.resize(clusters * rows);
    for (int c = 0; c < clusters; ++c) {
      const double common = random.normal();
      for (int k = 0; k < rows; ++k) {
        const int row = c * rows + k;
        A.row(row) << 1.0, random.normal(), random.normal() + c / 10.0;
        y[row] = A.row(row).dot(Eigen::Vector3d(1.0, -2.0, 0.5)) + common + 0.3 * random.normal();
        fit.cluster.push_back(c);
        fit.recording.push_back(c % 2);
      }
    }
    solve();
  }

  void solve() {
    x = A.colPivHouseholderQr().solve(y);
    fit.jacobian = A;
    fit.residual = A * x - y;
    fit.weight = VectorXd::Ones(y.size());
    fit.prior_information = VectorXd::Zero(A.cols());
  }

  /// The solution without the rows of which `group` is `left_out`.
  VectorXd without(const std::vector<int>& group, int left_out) const {
    MatrixXd rows = A;
    VectorXd values = y;
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      if (group[static_cast<std::size_t>(i)] != left_out) continue;
      rows.row(i).setZero();
      values[i] = 0.0;
    }
    return rows.colPivHouseholderQr().solve(values);
  }
};

TEST(Uncertainty, IsThatOfFitsWithoutOneClusterEach) {
  const Trial trial(1);
  MatrixXd sum = MatrixXd::Zero(3, 3);
  for (int c = 0; c < 20; ++c) {
    const VectorXd change = trial.without(trial.fit.cluster, c) - trial.x;
    sum += change * change.transpose();
  }
  constexpr double student = 2.093 / 1.960;  // 97.5 % quantile of Student's t with 19 degrees of freedom
  const MatrixXd expected = 19.0 / 20.0 * student * student * sum;
  const MatrixXd got = fit_uncertainty(trial.fit).covariance;
  EXPECT_LT((got - expected).norm(), 1e-3 * expected.norm());
}

TEST(Influence, OfARecordingIsWhatAFitWithoutItSays) {
  const Trial trial(2);
  const FitUncertainty got = fit_uncertainty(trial.fit);
  for (int g = 0; g < 2; ++g) {
    EXPECT_LT((got.influence.col(g) - (trial.without(trial.fit.recording, g) - trial.x)).norm(), 1e-9);
  }
}

TEST(Intervals, CoverTheTruthWhereErrorsAreShared) {
  int covered = 0;
  constexpr int trials = 400;
  for (int t = 0; t < trials; ++t) {
    const Trial trial(static_cast<std::uint64_t>(100 + t));
    const FitUncertainty got = fit_uncertainty(trial.fit);
    covered += std::abs(trial.x[0] - 1.0) < 1.96 * got.deviation[0] ? 1 : 0;
  }
  EXPECT_GE(covered, 0.92 * trials);
  EXPECT_LE(covered, 0.98 * trials);
}

TEST(WhatTheDataDoNotSee, IsToldNotInvented) {
  Trial trial(3);
  trial.A.conservativeResize(trial.A.rows(), 5);
  trial.A.col(3) = 2.0 * trial.A.col(1);
  trial.A.col(4).setZero();
  trial.solve();
  const FitUncertainty got = fit_uncertainty(trial.fit);
  EXPECT_EQ(got.rank, 3);
  EXPECT_TRUE(std::isinf(got.condition));
  EXPECT_EQ(got.identifiable, (std::vector<bool>{true, false, true, false, false}));
}

TEST(WhatIsOnlyBelieved, KeepsTheDeviationOfTheBelief) {
  Trial trial(4);
  trial.A.conservativeResize(trial.A.rows(), 4);
  trial.A.col(3).setZero();
  trial.solve();
  trial.fit.prior_information[3] = 1.0 / (0.02 * 0.02);
  const FitUncertainty got = fit_uncertainty(trial.fit);
  EXPECT_NEAR(got.deviation[3], 0.02, 1e-12);
  EXPECT_EQ(got.identifiable, (std::vector<bool>{true, true, true, false}));
}

}  // namespace
}  // namespace flinch
