#include "identification/zero_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace flinch {
namespace {

constexpr double period = 1e-3;

Eigen::MatrixXd sine(double frequency, int samples) {
  Eigen::MatrixXd x(samples, 1);
  for (int k = 0; k < samples; ++k) x(k, 0) = std::sin(2.0 * std::numbers::pi * frequency * k * period);
  return x;
}

TEST(ZeroPhase, LeavesHalfOfTheAmplitudeAtTheCutoffAndDelaysNothing) {
  const Eigen::MatrixXd x = sine(40.0, 2000);
  const Eigen::MatrixXd y = zero_phase(x, 40.0, period);
  EXPECT_LT((y.middleRows(500, 1000) - 0.5 * x.middleRows(500, 1000)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ZeroPhase, KeepsWhatIsSlowAndTakesWhatIsFast) {
  const Eigen::MatrixXd slow = sine(2.0, 2000);
  EXPECT_LT((zero_phase(slow, 40.0, period) - slow).middleRows(300, 1400).cwiseAbs().maxCoeff(), 2e-5);
  EXPECT_LT(zero_phase(sine(400.0, 2000), 40.0, period).middleRows(300, 1400).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(ZeroPhase, KeepsARampToItsEnds) {
  Eigen::MatrixXd ramp(500, 2);
  for (int k = 0; k < 500; ++k) ramp.row(k) << 0.01 * k, 3.0;
  EXPECT_LT((zero_phase(ramp, 30.0, period) - ramp).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(ZeroPhase, LeavesASingleSampleAsItIs) {
  EXPECT_EQ(zero_phase(Eigen::MatrixXd::Constant(1, 1, 7.0), 30.0, period)(0, 0), 7.0);
}

}  // namespace
}  // namespace flinch
