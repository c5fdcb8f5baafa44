#include "systems/contact/onset_ratio.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/support/answer_of_filters.h"

namespace flinch {
namespace {

constexpr std::size_t longest = OnsetMemory::longest, order = AutoregressiveError::order;

const AutoregressiveError slow{.prediction = {1.1, -0.3, 0.2, -0.1}, .innovation = 0.4};
const AutoregressiveError white{};

/// A residual whose change has errors of deviation 1.
const ResidualErrors unit{.noise = 1.0};

ResidualSample seen(const JointVector& change) {
  const JointVector none = JointVector::Zero(change.size());
  return {.is_new = true,
          .settled = true,
          .load = {.acquired = {},
                   .valid = true,
                   .rate = none,
                   .torque = none,
                   .friction = none,
                   .friction_bounds = {none, none},
                   .inertia = none,
                   .turning = none},
          .hidden = none,
          .level = {},
          .change = {change, none, none, none, none, none},
          .smoothed = {}};
}

ResidualTracking behind(int filters) {
  ResidualTracking tracking;
  tracking.answer = {.filters = filters, .rate = 300.0};
  return tracking;
}

/// The change that a step of 1 shows as, told by what follows residuals; its first sample is a tick after it.
std::vector<double> step_as_change(int filters) {
  ResidualTracking tracking = behind(filters);
  LoadHistory past;
  ResidualMemory memory, next;
  std::vector<double> change;
  DriveLoad load = seen(JointVector::Zero(1)).load;
  WrenchEstimate estimate;
  estimate.valid = true;
  for (int k = 0; k <= OnsetMemory::longest; ++k) {
    const Time now = k * Time(1ms);
    const double step = filters == 0 ? (k > 0 ? 1.0 : 0.0) : test::answer_of_three_filters(0.3 * k);
    load.acquired = estimate.acquired = now;
    estimate.drive_torque = JointVector::Constant(1, step);
    track_residual(estimate, load, past, now, tracking, memory, next);
    past.push(load);
    memory = next;
    if (k > 0) change.push_back(memory.seen.change.effort[0]);
  }
  return change;
}

using Rows = std::vector<JointVector>;

/// Errors of three drives that go as `course` says.
Rows errors_of(const AutoregressiveError& course, std::size_t samples, RandomGenerator& random) {
  Rows rows;
  for (std::size_t t = 0; t < samples; ++t) {
    JointVector z = JointVector::Zero(3);
    for (std::size_t j = 1; j <= std::min(t, order); ++j) z += course.prediction[j - 1] * rows[t - j];
    for (double& each : z) each += course.innovation * random.normal();
    rows.push_back(z);
  }
  return rows;
}

/// Minus twice the log likelihood of the last samples from `first` on, without its constant.
double misfit(const Rows& z, std::size_t first, int drive, const AutoregressiveError& course) {
  double sum = 0.0;
  for (std::size_t t = first; t < z.size(); ++t) {
    double e = z[t][drive];
    for (std::size_t j = 1; j <= order; ++j) e -= course.prediction[j - 1] * z[t - j][drive];
    sum += std::pow(e / course.innovation, 2);
  }
  return sum;
}

/// The largest 2 ln of the likelihood ratio over onsets and forces: for each onset the force of each drive is
/// taken off, which makes a parabola of the misfit, whose lowest point three values tell.
double searched(const Rows& z, const std::vector<double>& step, const AutoregressiveError& course) {
  double largest = 0.0;
  for (std::size_t k = 1; k <= longest; ++k) {
    const std::size_t first = z.size() - k;
    double gain = 0.0;
    for (int drive = 0; drive < z.back().size(); ++drive) {
      const auto without = [&](double force) {
        Rows rest = z;
        for (std::size_t t = first; t < z.size(); ++t) rest[t][drive] -= force * step[t - first];
        return misfit(rest, first, drive, course);
      };
      const double before = without(-1.0), none = without(0.0), after = without(1.0);
      const double bend = 0.5 * (after + before) - none, slope = 0.5 * (after - before);
      gain += slope * slope / (4.0 * bend);
    }
    largest = std::max(largest, gain);
  }
  return largest;
}

double distance_after(const Rows& rows, const OnsetRatio& ratio) {
  OnsetMemory memory, next;
  for (const JointVector& z : rows) {
    ratio.follow(seen(z), memory, next);
    memory = next;
  }
  return ratio.mahalanobis_distance(memory);
}

TEST(OnsetRatio, IsTheLargestLikelihoodRatioThatASearchFinds) {
  RandomGenerator random(5);
  for (const int filters : {0, 3}) {
    const std::vector<double> step = step_as_change(filters);
    for (const AutoregressiveError& course : {white, slow}) {
      const OnsetRatio ratio(unit, course, behind(filters));
      for (std::size_t trial = 0; trial < 20; ++trial) {
        Rows rows = errors_of(course, 60, random);
        for (std::size_t age = 0; age <= trial; ++age) {
          const double force = 3.0 * (1.0 - std::exp(-0.2 * static_cast<double>(trial - age)));
          rows[59 - age][static_cast<int>(trial % 3)] += force;
        }
        const double distance = distance_after(rows, ratio);
        EXPECT_NEAR(distance * distance, searched(rows, step, course), 1e-9 * distance * distance);
      }
    }
  }
}

// One onset is chi-square with three degrees of freedom; the likeliest of sixteen exceeds what one does at
// least as often as that, and at most sixteen times as often.
TEST(OnsetRatio, OfErrorsAsAssumedIsSeldomLarge) {
  RandomGenerator random(6);
  const OnsetRatio ratio(unit, slow, behind(3));
  OnsetMemory memory, next;
  constexpr std::size_t samples = 100'000;
  constexpr double squares[] = {11.345, 16.266, 21.108};  // that 1, 0.1 and 0.01 % exceed
  constexpr double share[] = {0.01, 0.001, 0.0001};
  std::array<int, 3> exceeded{};
  for (const JointVector& z : errors_of(slow, samples, random)) {
    ratio.follow(seen(z), memory, next);
    memory = next;
    for (std::size_t i = 0; i < 3; ++i)
      exceeded[i] += std::pow(ratio.mahalanobis_distance(memory), 2) > squares[i] ? 1 : 0;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GE(exceeded[i], share[i] * samples) << squares[i];
    EXPECT_LE(exceeded[i], OnsetMemory::longest * share[i] * samples) << squares[i];
  }
}

TEST(OnsetRatio, OfSilenceIsZero) {
  const OnsetRatio ratio(unit, slow, behind(3));
  EXPECT_EQ(distance_after(Rows(100, JointVector::Zero(3)), ratio), 0.0);
}

// Beside errors that are independent, n samples of a step are as surprising as one of root n times its size.
TEST(OnsetRatio, AddsUpAStepUntilTheWindowIsFull) {
  ResidualTracking without_mean = behind(0);
  without_mean.rate = 1e-9;
  const OnsetRatio ratio(unit, white, without_mean);
  OnsetMemory memory, next;
  for (int t = -30; t < 30; ++t) {
    ratio.follow(seen(Eigen::Vector3d(t < 0 ? 0.0 : 1.2, 0.0, t < 0 ? 0.0 : -1.6)), memory, next);
    memory = next;
    const int n = std::clamp(t + 1, 0, OnsetMemory::longest);
    EXPECT_NEAR(ratio.mahalanobis_distance(memory), 2.0 * std::sqrt(n), 1e-6) << t;
  }
}

TEST(OnsetRatio, DividesByTheDeviationsUnderTheLoad) {
  const ResidualErrors errors{.noise = 3.0, .load = 0.5};
  const OnsetRatio ratio(errors, white, behind(0));
  OnsetMemory memory, next;
  ResidualSample residual = seen(Eigen::Vector3d::Zero());
  residual.load.torque[1] = 8.0;
  for (int t = 0; t < 30; ++t) {
    residual.change.effort[1] = t < 29 ? 0.0 : 10.0;
    ratio.follow(residual, memory, next);
    memory = next;
  }
  EXPECT_NEAR(ratio.mahalanobis_distance(memory), 10.0 / std::hypot(3.0, 0.5 * 8.0), 1e-12);
}

TEST(OnsetRatio, KnowsNothingUntilItCanPredictAndAfterWhatMeansNothing) {
  const OnsetRatio ratio(unit, slow, behind(0));
  OnsetMemory memory, next;
  ResidualSample large = seen(Eigen::Vector3d(9.0, 0.0, 0.0));
  for (int times = 0; times < 2; ++times) {
    for (std::size_t t = 0; t < order; ++t) {
      ratio.follow(large, memory, next);
      memory = next;
      EXPECT_EQ(ratio.mahalanobis_distance(memory), 0.0);
    }
    large.change.effort[0] += 9.0;
    ratio.follow(large, memory, next);
    EXPECT_GT(ratio.mahalanobis_distance(next), 5.0);
    ResidualSample unsettled = large;
    unsettled.settled = false;
    ratio.follow(unsettled, next, memory);
    EXPECT_EQ(ratio.mahalanobis_distance(memory), 0.0);
  }
}

TEST(OnsetRatio, IsHeldWhileNothingIsNew) {
  RandomGenerator random(7);
  const OnsetRatio ratio(unit, slow, behind(3));
  OnsetMemory memory, next, held;
  for (const JointVector& z : errors_of(slow, 50, random)) {
    ratio.follow(seen(z), memory, next);
    ResidualSample old = seen(JointVector::Constant(3, 100.0));
    old.is_new = false;
    ratio.follow(old, next, held);
    EXPECT_EQ(ratio.mahalanobis_distance(held), ratio.mahalanobis_distance(next));
    memory = held;
  }
}

// As many samples behind a missing one tell as much as if nothing had been before it.
TEST(OnsetRatio, ForgetsWhatWasBeforeAMissingSample) {
  RandomGenerator random(9);
  const OnsetRatio ratio(unit, slow, behind(3));
  const Rows rows = errors_of(slow, 60, random);
  constexpr std::size_t missing = 30;
  OnsetMemory memory, fresh, next;
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (t == missing) continue;
    ResidualSample residual = seen(rows[t]);
    residual.load.acquired = static_cast<int>(t) * Time(1ms);
    ratio.follow(residual, memory, next);
    memory = next;
    if (t < missing) continue;
    ratio.follow(residual, fresh, next);
    fresh = next;
    EXPECT_EQ(ratio.mahalanobis_distance(memory), ratio.mahalanobis_distance(fresh)) << t;
  }
  EXPECT_GT(ratio.mahalanobis_distance(fresh), 0.0);
}

// The clock of an IMU is its own.
TEST(OnsetRatio, RemembersAcrossSamplesThatComeUnevenly) {
  RandomGenerator random(10);
  const OnsetRatio ratio(unit, slow, behind(0));
  OnsetMemory memory, next, uneven;
  Time acquired{};
  for (const JointVector& z : errors_of(slow, 60, random)) {
    ResidualSample residual = seen(z);
    ratio.follow(residual, memory, next);
    memory = next;
    acquired += acquired % 1ms == 0ms ? 1250us : 750us;
    residual.load.acquired = acquired;
    ratio.follow(residual, uneven, next);
    uneven = next;
    EXPECT_EQ(ratio.mahalanobis_distance(uneven), ratio.mahalanobis_distance(memory));
  }
}

TEST(OnsetRatio, OfAnEstimatorThatDoesNotAnswerInTimeIsZero) {
  ResidualTracking deaf = behind(3);
  deaf.answer.rate = 1e-30;
  const OnsetRatio ratio(unit, white, deaf);
  EXPECT_EQ(distance_after(Rows(50, JointVector::Constant(3, 9.0)), ratio), 0.0);
}

TEST(OnsetRatio, OfWhatIsNotFiniteIsInfiniteAndForgotten) {
  const OnsetRatio ratio(unit, slow, behind(3));
  Rows rows(50, JointVector::Zero(3));
  rows.back()[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(distance_after(rows, ratio), INFINITY);
  for (std::size_t t = 0; t < order + longest; ++t) rows.push_back(JointVector::Zero(3));
  EXPECT_EQ(distance_after(rows, ratio), 0.0);
}

TEST(OnsetRatio, NeverAllocates) {
  RandomGenerator random(8);
  const OnsetRatio ratio(unit, slow, behind(3));
  OnsetMemory memory, next;
  const Rows rows = errors_of(slow, 100, random);
  const test::AllocationCounter counter;
  double largest = 0.0;
  for (const JointVector& z : rows) {
    ratio.follow(seen(z), memory, next);
    memory = next;
    largest = std::max(largest, ratio.mahalanobis_distance(memory));
  }
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(largest, 0.0);
}

}  // namespace
}  // namespace flinch
