#include "identification/fit_uncertainty.h"
#include "systems/robot/decompositions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

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
    fit.bend = VectorXd::Zero(y.size());
    fit.block.resize(static_cast<std::size_t>(y.size()));
    std::iota(fit.block.begin(), fit.block.end(), 0);
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

/// Where vectors that scatter normally about 0 lie, by Tukey's loss of their lengths: a block of rows each.
struct RobustPlace {
  VectorXd place;
  LinearFit fit;

  RobustPlace(Eigen::Index size, RandomGenerator& random) {
    constexpr Eigen::Index blocks = 240, of_cluster = 4;
    constexpr double c = 4.685;
    MatrixXd y(size, blocks);
    for (double& value : y.reshaped()) value = random.normal();
    place.setZero(size);
    VectorXd inside(blocks);  // 1 - (|r| / c)^2, of which the weight is the square
    for (int step = 0; step < 60; ++step) {
      const MatrixXd left = y.colwise() - place;
      inside = (1.0 - left.colwise().squaredNorm().array() / (c * c)).cwiseMax(0.0).transpose();
      place = y * inside.cwiseAbs2() / inside.squaredNorm();
    }
    const Eigen::Index rows = size * blocks;
    fit.jacobian = MatrixXd::Identity(size, size).replicate(blocks, 1);
    fit.residual = (place.replicate(1, blocks) - y).reshaped();
    fit.weight = inside.cwiseAbs2().transpose().replicate(size, 1).reshaped();
    fit.bend = (-4.0 / (c * c) * inside).transpose().replicate(size, 1).reshaped();
    fit.prior_information.setZero(size);
    for (Eigen::Index row = 0; row < rows; ++row) {
      fit.block.push_back(static_cast<int>(row / size));
      fit.cluster.push_back(static_cast<int>(row / size / of_cluster));
      fit.recording.push_back(0);
    }
  }
};

// From weights alone, without the bend of the loss, deviations would be too small by 17 % for numbers and by
// 19 % for vectors in space.
TEST(DeviationsOfARobustFit, AreThoseByWhichItsSolutionsScatter) {
  RandomGenerator random(5);
  constexpr double student = 2.001 / 1.960;  // of 60 clusters
  for (const int size : {1, 3}) {
    constexpr int trials = 2000;
    double scatter = 0.0, stated = 0.0;
    for (int t = 0; t < trials; ++t) {
      const RobustPlace solution(size, random);
      scatter += solution.place.squaredNorm();
      stated += fit_uncertainty(solution.fit).deviation.squaredNorm();
    }
    EXPECT_NEAR(std::sqrt(stated / scatter) / student, 1.0, 0.05) << size;
  }
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
