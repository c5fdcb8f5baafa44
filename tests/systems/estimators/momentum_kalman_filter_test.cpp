#include "systems/estimators/momentum_kalman_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

constexpr double T = 1e-3;

PlatformVector three(double value) { return PlatformVector::Constant(3, value); }

/// The method by itself, on momenta that are given to it.
struct Filter {
  explicit Filter(const MomentumKalmanFilterSettings& settings = {}) : method(2, 1, settings) {}

  void begin(const PlatformVector& p) {
    memory = method.begin(p);
    last = p;
  }
  const PlatformVector& see(const PlatformVector& p, const PlatformVector& known, double interval = T) {
    MomentumKalmanMethod::Memory next;
    method.advance(memory, {interval, last, p, known}, next);
    memory = next;
    last = p;
    return memory.wrench;
  }
  WrenchEstimate told() const {
    WrenchEstimate estimate;
    method.describe(memory, estimate);
    return estimate;
  }

  MomentumKalmanMethod method;
  MomentumKalmanMethod::Memory memory;
  PlatformVector last;
};

/// Of the continuous filter with noise of density Q and R T, which has the poles w (-1 +- j) / sqrt(2),
/// w^4 = Q / (R T).
double answer_to_a_step(double t) {
  const double w = std::pow(10.0 / (1e-4 * T), 0.25) / std::sqrt(2.0);
  return 1.0 - std::exp(-w * t) * (std::cos(w * t) + std::sin(w * t));
}

TEST(MomentumKalmanFilter, AnswersAStepAsTheContinuousFilterOfThePaperDoes) {
  Filter filter;
  filter.begin(three(0.0));
  double largest = 0.0;
  for (int k = 1; k < 300; ++k) {
    const PlatformVector& wrench = filter.see(three(80.0 * k * T), three(0.0));
    largest = std::max(largest, std::abs(wrench[0] - 80.0 * answer_to_a_step(k * T)));
  }
  EXPECT_LT(largest, 0.03 * 80.0);  // of a step of 1 ms beside a time constant of 14 ms
}

TEST(MomentumKalmanFilter, HasNoStaticErrorForAConstantForce) {
  Filter filter;
  filter.begin(three(3.0));
  const PlatformVector F{{80.0, -15.0, 2.0}}, s{{-20.0, 7.0, 0.3}};
  PlatformVector wrench;
  for (int k = 1; k < 1000; ++k) wrench = filter.see(three(3.0) + k * T * (F + s), s);
  EXPECT_LT((wrench - F).norm(), 1e-9);
}

// A force that wanders and momenta that are noisy, as the filter was told: the estimate misses the force as
// it says, and its innovations are as large as it expects.
TEST(MomentumKalmanFilter, MissesTheForceByTheDeviationThatItTells) {
  Filter filter;
  filter.begin(three(0.0));
  RandomGenerator random(7);
  const PlatformVector walk{{std::sqrt(10.0), std::sqrt(10.0), std::sqrt(0.1)}};
  const PlatformVector noise{{0.01, 0.01, 0.001}};
  PlatformVector force = three(0.0), momentum = three(0.0), squares = three(0.0);
  double innovation = 0.0;
  constexpr int count = 400'000, fine = 10;
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < fine; ++i) {  // Euler steps, short beside the sampling period
      for (int j = 0; j < 3; ++j) force[j] += walk[j] * std::sqrt(T / fine) * random.normal();
      momentum += T / fine * force;
    }
    PlatformVector seen = momentum;
    for (int j = 0; j < 3; ++j) seen[j] += noise[j] * random.normal();
    squares += (filter.see(seen, three(0.0)) - force).cwiseAbs2() / count;
    innovation += filter.told().health.innovation / count;
  }
  const PlatformVector ratio = squares.cwiseSqrt().cwiseQuotient(filter.told().standard_deviation);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(ratio[j], 1.0, 0.02) << j;
  EXPECT_NEAR(innovation, 1.0, 0.01);
}

TEST(MomentumKalmanFilter, NoticesNoiseThatItWasNotToldOf) {
  Filter filter;
  filter.begin(three(0.0));
  RandomGenerator random(8);
  double mean = 0.0;
  for (int k = 0; k < 20'000; ++k) {
    PlatformVector seen = three(0.0);
    for (int j = 0; j < 3; ++j) seen[j] = 4.0 * (j < 2 ? 0.01 : 0.001) * random.normal();
    filter.see(seen, three(0.0));
    mean += filter.told().health.innovation / 20'000;
  }
  EXPECT_GT(mean, 8.0);
}

TEST(MomentumKalmanFilter, TrustsItsForceLessAfterAMissingSample) {
  Filter filter;
  filter.begin(three(0.0));
  const double steady = filter.told().standard_deviation[0];
  filter.see(three(0.0), three(0.0));
  EXPECT_NEAR(filter.told().standard_deviation[0], steady, 1e-9 * steady);
  filter.see(three(0.0), three(0.0), 3 * T);
  EXPECT_GT(filter.told().standard_deviation[0], 1.02 * steady);
}

TEST(MomentumKalmanFilter, SettlesInFiveOfItsTimeConstants) {
  EXPECT_NEAR(to_seconds(Filter().method.settling_time()), 5.0 / 71.0, 0.006);
}

TEST(MomentumKalmanFilter, AsksForNoiseThatIsPositive) {
  const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
  MomentumKalmanFilterSettings settings;
  settings.translation.force_density = 0.0;
  settings.rotation.momentum_deviation = std::numeric_limits<double>::quiet_NaN();
  try {
    const MomentumKalmanFilter filter(robot, settings);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

}  // namespace
}  // namespace flinch
