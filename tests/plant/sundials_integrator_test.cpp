#include "plant/sundials_integrator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "plant/hunt_crossley.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/runge_kutta.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

/// x'' = -omega^2 x
class Oscillator final : public DifferentialEquation {
 public:
  explicit Oscillator(double omega) : omega_(omega) {}
  void rates(double, std::span<const double> y, std::span<double> rates) override {
    rates[0] = y[1];
    rates[1] = -omega_ * omega_ * y[0];
  }

 private:
  double omega_;
};

/// A ball under gravity above a surface 10 times as stiff as a pylon: y = (height, its rate).
class BouncingBall final : public DifferentialEquation {
 public:
  void rates(double, std::span<const double> y, std::span<double> rates) override {
    rates[0] = y[1];
    rates[1] = -9.81 + law_.normal_force(-y[0], -y[1]) / 0.5;
  }

 private:
  HuntCrossley law_{ContactMaterial{.stiffness = 6e4}};
};

/// y' = t: depends on time alone.
class Ramp final : public DifferentialEquation {
 public:
  void rates(double t, std::span<const double>, std::span<double> rates) override { rates[0] = t; }
};

/// Rates that no step can follow.
class Noise final : public DifferentialEquation {
 public:
  void rates(double, std::span<const double>, std::span<double> rates) override {
    rates[0] = std::uniform_real_distribution<double>(-1e6, 1e6)(random_);
  }

 private:
  std::mt19937_64 random_{1};
};

class EachTableau : public testing::TestWithParam<SundialsOptions::Tableau> {
 protected:
  SundialsOptions options() const { return {.tableau = GetParam()}; }
};

INSTANTIATE_TEST_SUITE_P(SundialsIntegrator, EachTableau,
                         testing::Values(SundialsOptions::Tableau::cash_karp,
                                         SundialsOptions::Tableau::dormand_prince));

TEST_P(EachTableau, FollowsAHarmonicOscillator) {
  const double omega = 2.0 * M_PI * 20.0;
  Oscillator oscillator(omega);
  SundialsIntegrator integrator(options());
  integrator.prepare(2);
  std::array<double, 2> y = {1.0, 0.0};
  for (int k = 1; k <= 1000; ++k) {
    ASSERT_TRUE(integrator.advance(oscillator, 1e-3, y));
    const double t = 1e-3 * k;
    EXPECT_NEAR(y[0], std::cos(omega * t), 1e-6);
    EXPECT_NEAR(y[1], -omega * std::sin(omega * t), 1e-6 * omega);
  }
}

TEST_P(EachTableau, TightensWithItsTolerance) {
  const auto error = [&](double tolerance) {
    Oscillator oscillator(300.0);
    SundialsOptions tight = options();
    tight.relative_tolerance = tolerance;
    tight.absolute_tolerance = tolerance;
    SundialsIntegrator integrator(tight);
    integrator.prepare(2);
    std::array<double, 2> y = {1.0, 0.0};
    for (int k = 0; k < 200; ++k) integrator.advance(oscillator, 1e-3, y);
    return std::abs(y[0] - std::cos(300.0 * 0.2));
  };
  EXPECT_LT(error(1e-6), 1e-3);
  EXPECT_LT(error(1e-8), 1e-5);
  EXPECT_LT(error(1e-11), 1e-8);
}

TEST_P(EachTableau, FollowsABouncingBallAsTinyFixedStepsDo) {
  BouncingBall ball;
  SundialsIntegrator integrator(options());
  RungeKutta tiny(1000);
  integrator.prepare(2);
  tiny.prepare(2);
  std::array<double, 2> y = {0.05, 0.0};
  std::array<double, 2> reference = y;
  for (int k = 0; k < 600; ++k) {
    ASSERT_TRUE(integrator.advance(ball, 1e-3, y));
    tiny.advance(ball, 1e-3, reference);
    ASSERT_NEAR(y[0], reference[0], 2e-8) << k;
    ASSERT_NEAR(y[1], reference[1], 5e-6) << k;
  }
}

TEST(SundialsIntegrator, TellsTheEquationTheTimeWithinTheStep) {
  Ramp ramp;
  SundialsIntegrator integrator;
  integrator.prepare(1);
  std::array<double, 1> y = {0.0};
  for (int k = 0; k < 3; ++k) integrator.advance(ramp, 0.5, y);
  EXPECT_NEAR(y[0], 3.0 * 0.125, 1e-12);
}

TEST(SundialsIntegrator, RemembersNothingOfEarlierSteps) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> height(-0.01, 0.01);
  std::uniform_real_distribution<double> speed(-2.0, 2.0);
  BouncingBall ball;
  SundialsIntegrator experienced;
  experienced.prepare(2);
  for (int trial = 0; trial < 300; ++trial) {
    const std::array<double, 2> start = {height(random), speed(random)};
    SundialsIntegrator fresh;
    fresh.prepare(2);
    std::array<double, 2> a = start;
    std::array<double, 2> b = start;
    fresh.advance(ball, 1e-3, a);
    experienced.advance(ball, 1e-3, b);
    ASSERT_EQ(a, b) << "bit for bit, trial " << trial;
  }
}

TEST(SundialsIntegrator, DoesNotAllocateOnceStarted) {
  BouncingBall ball;
  SundialsIntegrator integrator;
  integrator.prepare(2);
  std::array<double, 2> y = {0.001, -1.0};
  integrator.advance(ball, 1e-3, y);
  const test::AllocationCounter counter;
  for (int k = 0; k < 500; ++k) integrator.advance(ball, 1e-3, y);
  EXPECT_EQ(counter.count(), 0);
}

TEST(SundialsIntegrator, SaysWhenItMissesItsToleranceAndStillArrives) {
  Noise noise;
  SundialsIntegrator integrator({.max_steps = 50});
  integrator.prepare(1);
  std::array<double, 1> y = {0.0};
  testing::internal::CaptureStderr();
  EXPECT_FALSE(integrator.advance(noise, 1e-3, y));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(std::isfinite(y[0]));
  EXPECT_NE(y[0], 0.0);

  Ramp ramp;
  y = {0.0};
  EXPECT_TRUE(integrator.advance(ramp, 1.0, y)) << "a bad step leaves no trace";
  EXPECT_NEAR(y[0], 0.5, 1e-12);
}

TEST(SundialsIntegrator, CountsRightHandSides) {
  Ramp ramp;
  SundialsIntegrator integrator;
  integrator.prepare(1);
  EXPECT_EQ(integrator.evaluations(), 0);
  std::array<double, 1> y = {0.0};
  integrator.advance(ramp, 1e-3, y);
  EXPECT_EQ(integrator.evaluations(), 6) << "none for a step that never follows";
}

TEST(SundialsIntegrator, NeedsNoStates) {
  Ramp ramp;
  SundialsIntegrator integrator;
  integrator.prepare(0);
  EXPECT_TRUE(integrator.advance(ramp, 1e-3, {}));
}

TEST(SundialsIntegrator, RefusesTolerancesThatAreNotPositive) {
  try {
    SundialsIntegrator integrator({.relative_tolerance = 0.0, .absolute_tolerance = -1.0, .max_steps = 0});
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
  }
}

}  // namespace
}  // namespace flinch
