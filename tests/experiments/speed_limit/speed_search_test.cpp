#include "experiments/speed_limit/speed_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "systems/framework/random.h"

namespace flinch {
namespace {

using Bound = FoundSpeed::Bound;

/// Trials each of which exceeds above a speed of its own, and does not come about above another [m/s].
struct Thresholds {
  std::vector<double> speeds;
  std::vector<double> reached = std::vector<double>(speeds.size(), 100.0);
  std::set<double> tried = {};
  std::size_t runs = 0;

  TrialResult operator()(std::size_t trial, double speed) {
    tried.insert(speed);
    ++runs;
    if (speed > reached[trial]) return {};
    return {speed <= speeds[trial] ? SpeedTrial::within : SpeedTrial::exceeded,
            noise(trial) * speed / speeds[trial]};
  }
  /// How near a trial comes to its limit at a low speed tells only about how near it comes at a high one.
  double noise(std::size_t trial) const { return 1.0 + 0.3 * std::sin(static_cast<double>(trial * trial)); }
  std::size_t untested_at(double speed) const {
    return static_cast<std::size_t>(
        std::count_if(reached.begin(), reached.end(), [speed](double own) { return speed > own; }));
  }
  std::size_t exceeded_at(double speed) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < speeds.size(); ++i) count += speed > speeds[i] && speed <= reached[i] ? 1 : 0;
    return count;
  }
};

FoundSpeed search(const SpeedSearch& settings, Thresholds& trials) {
  return find_speed(settings, [&](std::size_t trial, double speed) { return trials(trial, speed); });
}

/// What counts have to be at the speed that is found, and must not be a step above.
TEST(SpeedSearch, FindsASpeedAboveWhichTooManyExceedOrAreUntested) {
  RandomGenerator random(5);
  std::map<Bound, int> bounds;
  for (int round = 0; round < 500; ++round) {
    SpeedSearch settings{.trials = 2 + random() % 60};
    settings.tolerated = random() % (settings.trials / 2 + 1);
    settings.spares = random() % (settings.trials / 2 + 1);
    const bool has_room = round % 2 == 0;
    Thresholds trials;
    for (std::size_t i = 0; i < settings.trials; ++i) {
      trials.speeds.push_back(std::exp(random.uniform(std::log(0.08), std::log(4.0))));
      trials.reached.push_back(has_room ? 100.0 : random.uniform(0.5, 3.0));
    }
    const auto is_within = [&](double speed) {
      return trials.exceeded_at(speed) <= settings.tolerated && trials.untested_at(speed) <= settings.spares;
    };
    const FoundSpeed found = search(settings, trials);
    ++bounds[found.bound];
    if (!found.speed) {
      EXPECT_FALSE(is_within(settings.slowest));
      continue;
    }
    EXPECT_TRUE(is_within(*found.speed));
    EXPECT_EQ(found.exceeded, trials.exceeded_at(*found.speed));
    EXPECT_EQ(found.untested, trials.untested_at(*found.speed));
    if (found.bound == Bound::fastest) {
      EXPECT_EQ(*found.speed, settings.fastest);
    } else if (has_room) {  // then the more exceed the faster it is; speeds are whole mm/s
      EXPECT_FALSE(is_within(*found.speed * (1.0 + settings.step) + 0.001));
    }
  }
  EXPECT_EQ(bounds.size(), 3U);
}

TEST(SpeedSearch, TellsAForceFromAMotionThatIsNotFastEnough) {
  const SpeedSearch settings{.trials = 3, .spares = 1};
  Thresholds slow{.speeds = {5.0, 5.0, 5.0}, .reached = {0.9, 0.7, 1.5}};
  const FoundSpeed found = search(settings, slow);
  EXPECT_EQ(found.bound, Bound::motion);
  EXPECT_NEAR(found.speed.value(), 0.9, 0.03 * 0.9) << "one may be untested";
  EXPECT_EQ(found.untested, 1U);
  Thresholds never{.speeds = {5.0, 5.0, 5.0}, .reached = {0.01, 0.01, 1.5}};
  EXPECT_EQ(search(settings, never), (FoundSpeed{std::nullopt, Bound::motion, 0, 2}));
}

TEST(SpeedSearch, TriesOneSpeedWhereBothEndsAreTheSame) {
  const SpeedSearch settings{.slowest = 0.5, .fastest = 0.5, .trials = 2};
  Thresholds within{{0.6, 0.7}};
  EXPECT_EQ(search(settings, within), (FoundSpeed{0.5, Bound::fastest, 0, 0}));
  Thresholds beyond{{0.6, 0.4}};
  EXPECT_EQ(search(settings, beyond).speed, std::nullopt);
}

/// 102 speeds are told apart by seven halvings, each with one trial; all are tried at the ends of rounds.
TEST(SpeedSearch, TriesAllAtFewSpeeds) {
  RandomGenerator random(9);
  constexpr std::size_t rounds = 200;
  std::size_t runs = 0;
  for (std::size_t round = 0; round < rounds; ++round) {
    const SpeedSearch settings{.trials = 29};
    Thresholds trials;
    trials.reached.assign(settings.trials, 100.0);
    for (std::size_t i = 0; i < settings.trials; ++i)
      trials.speeds.push_back(1.3 / std::cos(random.uniform(-0.75, 0.75)));
    search(settings, trials);
    runs += trials.runs;
  }
  EXPECT_LT(runs / rounds, 100U) << "not 29 at each of nine speeds";
}

}  // namespace
}  // namespace flinch
