#include "systems/estimators/sliding_mode_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "systems/estimators/momentum_observer.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

constexpr double T = 1e-3;

PlatformVector three(double value) { return PlatformVector::Constant(3, value); }

/// A force that rises at `rate` up to `peak`, and the momentum that it has given.
struct Ramp {
  double rate, peak;
  double force(double t) const { return std::min(rate * t, peak); }
  double momentum(double t) const {
    const double end = peak / rate;
    return t < end ? 0.5 * rate * t * t : peak * (t - 0.5 * end);
  }
};

/// What a method makes of a ramp in each coordinate, in that of x, sample by sample.
template <class Method>
std::vector<double> estimates(const Method& method, const Ramp& ramp, int count) {
  std::vector<double> seen;
  PlatformVector last = three(5.0);
  auto memory = method.begin(last);
  for (int k = 1; k <= count; ++k) {
    const PlatformVector p = three(5.0 + ramp.momentum(k * T));
    auto next = memory;
    method.advance(memory, {T, last, p, three(0.0)}, next);
    memory = next;
    last = p;
    seen.push_back(memory.wrench[0]);
  }
  return seen;
}

/// Root of the mean square of estimate minus force from sample `first` on.
double chatter(const std::vector<double>& seen, const Ramp& ramp, std::size_t first) {
  double sum = 0.0;
  for (std::size_t k = first; k < seen.size(); ++k) {
    const double error = seen[k] - ramp.force(static_cast<double>(k + 1) * T);
    sum += error * error / static_cast<double>(seen.size() - first);
  }
  return std::sqrt(sum);
}

std::ptrdiff_t samples_until(const std::vector<double>& seen, double threshold) {
  return std::find_if(seen.begin(), seen.end(), [&](double F) { return F >= threshold; }) - seen.begin() + 1;
}

constexpr Ramp impact{2000.0, 80.0};  // as on the rig: 80 N within 40 ms

TEST(SlidingModeObserver, FollowsAForceThatChangesNoFasterThanItWasToldWithoutLag) {
  const auto seen = estimates(SlidingModeMethod(2, {}), {2000.0, 1e9}, 300);
  for (std::size_t k = 60; k < seen.size(); ++k) {
    ASSERT_NEAR(seen[k], 2000.0 * static_cast<double>(k + 1) * T, 2.5) << k;  // a lag of 1.25 ms at most
  }
}

TEST(SlidingModeObserver, LosesAForceThatChangesFaster) {
  const auto seen = estimates(SlidingModeMethod(2, {}), {6000.0, 1e9}, 100);
  EXPECT_GT(6000.0 * 0.1 - seen.back(), 50.0);
}

TEST(SlidingModeObserver, NoticesAnImpactLongBeforeTheMomentumObserverOfThePaper) {
  const auto sliding = estimates(SlidingModeMethod(2, {}), impact, 100);
  const auto first_order = estimates(FirstOrderMomentumMethod(three(20.0)), impact, 100);
  EXPECT_NEAR(static_cast<double>(samples_until(sliding, 12.0)), 7.0, 1.0);
  EXPECT_NEAR(static_cast<double>(samples_until(first_order, 12.0)), 27.0, 1.0);
}

TEST(SlidingModeObserver, ChattersTenTimesLessForItsSubsteps) {
  SlidingModeObserverSettings coarse;
  coarse.substeps = 1;
  const double with = chatter(estimates(SlidingModeMethod(2, {}), impact, 400), impact, 150);
  const double without = chatter(estimates(SlidingModeMethod(2, coarse), impact, 400), impact, 150);
  EXPECT_LT(with, 0.3);
  EXPECT_GT(without, 10.0 * with);
}

/// Of a method under white noise of the momentum; and what it tells of itself.
template <class Method>
void expect_deviation_as_told(const Method& method, double of_momentum, double tolerance) {
  RandomGenerator random(17);
  auto memory = method.begin(three(0.0)), next = memory;
  PlatformVector before = three(0.0);
  double squares = 0.0;
  constexpr int settled = 500, counted = 20'000;
  for (int k = 0; k < settled + counted; ++k) {
    const PlatformVector now = three(of_momentum * random.normal());
    method.advance(memory, {T, before, now, three(0.0)}, next);
    if (k >= settled) squares += next.wrench[0] * next.wrench[0] / counted;
    memory = next;
    before = now;
  }
  WrenchEstimate told;
  method.describe(memory, told);
  EXPECT_NEAR(told.standard_deviation[0] / std::sqrt(squares), 1.0, tolerance);
}

TEST(SlidingModeObserver, TellsTheDeviationThatNoiseOfTheMomentumCauses) {
  expect_deviation_as_told(SlidingModeMethod(2, {}), SlidingModeObserverSettings().deviation.translation,
                           0.2);
}

TEST(SlidingModeObserver, BridgesMissingSamplesWithMoreSubsteps) {
  const SlidingModeMethod method(2, {});
  auto one = method.begin(three(0.0)), two = one, next = one;
  for (int k = 0; k < 100; ++k) {  // a constant force, sampled every millisecond and every two
    for (int half = 0; half < 2; ++half) {
      const double t = (2 * k + half) * T;
      method.advance(one, {T, three(30.0 * t), three(30.0 * (t + T)), three(0.0)}, next);
      one = next;
    }
    method.advance(two, {2 * T, three(60.0 * k * T), three(60.0 * (k + 1) * T), three(0.0)}, next);
    two = next;
    ASSERT_LT((one.wrench - two.wrench).norm(), 1e-6) << k;
  }
}

TEST(SlidingModeObserver, AsksForSettingsThatArePositive) {
  const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
  SlidingModeObserverSettings settings;
  settings.force_rate = std::numeric_limits<double>::infinity();
  settings.substeps = 0;
  try {
    const SlidingModeObserver observer(robot, settings);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

}  // namespace
}  // namespace flinch
