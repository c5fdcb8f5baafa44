#include "identification/torque_constant_fit.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(ResidualsOfPulls, HaveTheDerivativesThatDifferencesShow) {
  const SyntheticPulls truth{.misalignment = 0.03, .current_noise = 0.01, .torque_noise = 0.2};
  const std::vector<PullWindow> windows = make(truth, 3);
  const TorqueConstantModel model;
  const TorqueConstantFit fit = fitted(windows, model);
  const auto residual = [&](const TorqueConstantFit& at, std::size_t row) {
    const PullWindow& w = windows[fit.window_of_row[row]];
    const int i = fit.drive_of_row[row];
    return torque_residual(w, i, at, model.slow) /
           std::hypot(at.deviation[i], at.constant[i] * w.current_deviation[i]);
  };
  const auto moved = [&](Eigen::Index column, double step) {
    TorqueConstantFit at = fit;
    const Eigen::Index drive = column / 3;
    if (column >= 9) {
      at.misalignment[static_cast<std::size_t>(column - 9)].z() += step;
    } else {
      (column % 3 == 0 ? at.constant : column % 3 == 1 ? at.offset : at.coulomb)[drive] += step;
    }
    return at;
  };
  ASSERT_EQ(fit.linear.jacobian.cols(), 9 + 7);
  const double largest = fit.linear.jacobian.cwiseAbs().maxCoeff();
  constexpr double h = 1e-5;
  for (std::size_t row = 0; row < fit.window_of_row.size(); row += 7) {
    for (Eigen::Index column = 0; column < fit.linear.jacobian.cols(); ++column) {
      const double difference =
          (residual(moved(column, h), row) - residual(moved(column, -h), row)) / (2.0 * h);
      EXPECT_NEAR(fit.linear.jacobian(static_cast<Eigen::Index>(row), column), difference, 1e-6 * largest);
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
