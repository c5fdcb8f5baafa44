#include "identification/torque_constant_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/identification/synthetic_pulls.h"

namespace flinch {
namespace {

using test::make;
using test::SyntheticPulls;

const Eigen::Vector3d believed = Eigen::Vector3d::Constant(6.1);

TorqueConstantFit fitted(const std::vector<PullWindow>& windows, TorqueConstantModel model = {}) {
  return fit_torque_constants(windows, 7, believed, model);
}

/// The slope of one drive by ordinary regression of what the rope does on the current: the closed form.
double ordinary_slope(const std::vector<PullWindow>& windows, int drive) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  const double n = static_cast<double>(windows.size());
  for (const PullWindow& w : windows) {
    const double x = w.current[drive], y = -w.projected()[drive];
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(TorqueConstantFit, FindsWhatIsTrueWithoutNoise) {
  const SyntheticPulls truth{.misalignment = 0.035};
  TorqueConstantModel model;
  model.misalignment_belief = 1e3;  // nothing pulls it to zero
  const TorqueConstantFit fit = fitted(make(truth, 1), model);
  EXPECT_LT((fit.constant - truth.constant).norm(), 1e-5);
  EXPECT_LT((fit.offset - truth.offset).norm(), 1e-5);
  EXPECT_LT((fit.coulomb - truth.coulomb).norm(), 1e-5);
}

TEST(TorqueConstantFit, IsTheOrdinaryRegressionWhereNothingElseIsLookedFor) {
  const SyntheticPulls truth{.coulomb = Eigen::Vector3d::Zero(), .torque_noise = 0.3};
  const std::vector<PullWindow> windows = make(truth, 2);
  TorqueConstantModel model;
  model.coulomb = false;
  model.misalignment = false;
  const TorqueConstantFit fit = fitted(windows, model);
  for (int i = 0; i < 3; ++i) {
    // The loss leaves a little less weight to what is far off; the slopes differ by a part of their
    // deviation.
    const double deviation = fit_uncertainty(fit.linear).deviation[2 * i];
    EXPECT_NEAR(fit.constant[i], ordinary_slope(windows, i), 0.5 * deviation);
    EXPECT_NEAR(fit.constant[i], truth.constant[i], 4.0 * deviation);
  }
}

// [Fuller, Measurement Error Models, 1.1]: noise in the current flattens the slope by
// var(i) / (var(i) + var(noise)).
TEST(NoiseOfTheCurrent, FlattensTheOrdinarySlopeButNotOurs) {
  const SyntheticPulls truth{.coulomb = Eigen::Vector3d::Zero(), .current_noise = 0.6, .windows = 60};
  TorqueConstantModel model;
  model.coulomb = false;
  model.misalignment = false;
  Eigen::Vector3d ordinary = Eigen::Vector3d::Zero(), ours = Eigen::Vector3d::Zero();
  constexpr int trials = 10;
  for (int t = 0; t < trials; ++t) {
    const std::vector<PullWindow> windows = make(truth, static_cast<std::uint64_t>(10 + t));
    const TorqueConstantFit fit = fitted(windows, model);
    for (int i = 0; i < 3; ++i) {
      ordinary[i] += ordinary_slope(windows, i) / truth.constant[i] / trials;
      ours[i] += fit.constant[i] / truth.constant[i] / trials;
    }
  }
  EXPECT_LT(ordinary.maxCoeff(), 0.97) << "there is nothing to show unless the noise matters";
  EXPECT_LT((ours.array() - 1.0).abs().maxCoeff(), 0.006);
}

/// Pulls at a robot whose dynamic parameters are off, in every drive another wave.
std::vector<PullWindow> pulls_of_everything() {
  const SyntheticPulls truth{
      .misalignment = 0.03, .current_noise = 0.01, .torque_noise = 0.05, .windows = 40};
  std::vector<PullWindow> windows = make(truth, 3);
  RandomGenerator random(4);
  const Eigen::Vector2d surplus(0.8, -0.5);
  for (PullWindow& window : windows) {
    window.effort_slopes.resize(3, 2);
    for (double& slope : window.effort_slopes.reshaped()) slope = random.normal();
    window.current += (window.effort_slopes * surplus).cwiseQuotient(truth.constant);
    window.current[0] -= 0.1 * std::sin(24.0 * window.position[0]);
    window.current[1] /= 1.0 + 0.1 * std::sin(30.0 * window.position[1]);
  }
  return windows;
}

using Move = std::function<void(TorqueConstantFit&, double)>;

/// What each column of the fit moves.
std::vector<Move> moves_of(const TorqueConstantFit& fit) {
  std::vector<Move> moves;
  for (Eigen::Index i = 0; i < 3; ++i) {
    moves.push_back([i](TorqueConstantFit& at, double step) { at.constant[i] += step; });
    moves.push_back([i](TorqueConstantFit& at, double step) { at.offset[i] += step; });
    moves.push_back([i](TorqueConstantFit& at, double step) { at.coulomb[i] += step; });
    const auto wave = [](TorqueConstantFit& of, std::size_t number) -> PullWave& {
      return number < of.cogging.size() ? of.cogging[number] : of.ripple;
    };
    std::vector<std::size_t> found;
    TorqueConstantFit here = fit;
    for (std::size_t number = 0; number <= fit.cogging.size(); ++number)
      if (wave(here, number).rate[i] > 0.0) found.push_back(number);
    for (const std::size_t number : found) {
      for (const int part : {0, 1}) {
        moves.push_back([=](TorqueConstantFit& at, double step) { wave(at, number).parts(part, i) += step; });
      }
    }
    for (const std::size_t number : found)
      moves.push_back([=](TorqueConstantFit& at, double step) { wave(at, number).rate[i] += step; });
  }
  for (std::size_t m = 0; m < fit.misalignment.size(); ++m)
    moves.push_back([m](TorqueConstantFit& at, double step) { at.misalignment[m].z() += step; });
  for (Eigen::Index j = 0; j < fit.surplus.size(); ++j)
    moves.push_back([j](TorqueConstantFit& at, double step) { at.surplus[j] += step; });
  return moves;
}

TEST(ResidualsOfPulls, HaveTheDerivativesThatDifferencesShow) {
  const std::vector<PullWindow> windows = pulls_of_everything();
  const TorqueConstantModel model;
  const TorqueConstantFit fit = fitted(windows, model);
  EXPECT_NEAR(fit.cogging[0].rate[0], 24.0, 1.0);
  EXPECT_NEAR(fit.ripple.rate[1], 30.0, 1.0);
  ASSERT_EQ(fit.surplus.size(), 2);
  const auto residual = [&](const TorqueConstantFit& at, std::size_t row) {
    const PullWindow& w = windows[fit.window_of_row[row]];
    const int i = fit.drive_of_row[row];
    return torque_residual(w, i, at, model.slow) /
           std::hypot(at.deviation[i], at.constant[i] * w.current_deviation[i]);
  };
  const std::vector<Move> moves = moves_of(fit);
  ASSERT_EQ(fit.linear.jacobian.cols(), static_cast<Eigen::Index>(moves.size()));
  for (std::size_t column = 0; column < moves.size(); ++column) {
    const Eigen::VectorXd got = fit.linear.jacobian.col(static_cast<Eigen::Index>(column));
    const double largest = got.cwiseAbs().maxCoeff();
    EXPECT_GT(largest, 0.0) << "column " << column;
    for (std::size_t row = 0; row < fit.window_of_row.size(); row += 7) {
      constexpr double h = 1e-5;
      TorqueConstantFit more = fit, less = fit;
      moves[column](more, h);
      moves[column](less, -h);
      const double difference = (residual(more, row) - residual(less, row)) / (2.0 * h);
      EXPECT_NEAR(got[static_cast<Eigen::Index>(row)], difference, 1e-6 * largest) << "column " << column;
    }
  }
}

TEST(AFifthOfOutliers, MovesNoParameterByMoreThanItsDeviation) {
  const SyntheticPulls truth{.misalignment = 0.035, .torque_noise = 0.2, .cogging = 0.5};
  std::vector<PullWindow> windows = make(truth, 4);
  const TorqueConstantFit clean = fitted(windows);
  RandomGenerator random(5);
  for (PullWindow& window : windows) {
    if (random.uniform(0.0, 1.0) < 0.2) window.force *= random.uniform(-1.0, 3.0);
  }
  const TorqueConstantFit spoilt = fitted(windows);
  const Eigen::VectorXd deviation = fit_uncertainty(spoilt.linear).deviation;
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(spoilt.constant[i] - clean.constant[i]), deviation[3 * i]);
    EXPECT_LT(std::abs(spoilt.offset[i] - clean.offset[i]), deviation[3 * i + 1]);
  }
}

}  // namespace
}  // namespace flinch
